// What an emulated board measures of its firmware: cycles of marked code, and the deepest stack.

export const PAINT = 0xc5; // what the memory holds before the firmware starts

// Cycles of the code between two marks; the caller leaves interrupts out of its count.
export class Segments {
  constructor() {
    this.count = 0;
    this.sum = 0;
    this.min = Infinity;
    this.max = 0;
    this.beginning = null;
  }

  // value: what the firmware wrote to the mark, 0 at the end; cycles: its own count so far.
  mark(value, cycles) {
    if (value !== 0) {
      this.beginning = cycles;
    } else if (this.beginning !== null) {
      this.#add(cycles - this.beginning);
      this.beginning = null;
    }
  }

  #add(cycles) {
    this.count += 1;
    this.sum += cycles;
    this.min = Math.min(this.min, cycles);
    this.max = Math.max(this.max, cycles);
  }
}

// Bytes of stack used so far: all above the longest run of paint that is left. The stack begins at
// the end of the memory.
export function stackBytes(memory, paint = PAINT) {
  let longest = 0;
  let end = memory.length;
  let intact = 0;
  for (let i = 0; i < memory.length; i++) {
    intact = memory[i] === paint ? intact + 1 : 0;
    if (intact > longest) {
      longest = intact;
      end = i + 1;
    }
  }
  return memory.length - end;
}
