// The content of a board's non-volatile store, kept from run to run, and a supply that may fail.

const ERASED = 0xff;

export class NonVolatile {
  // initial: its first bytes; the rest is erased. cutAfter: bytes that are written before the supply
  // fails.
  constructor(initial, cutAfter) {
    this.initial = initial;
    this.left = cutAfter;
    this.bytes = new Uint8Array(initial);
  }

  // Called once by the machine, with its size; returns the bytes, which are the machine's to change.
  mount(size) {
    this.bytes = new Uint8Array(size).fill(ERASED);
    this.bytes.set(this.initial.subarray(0, size));
    return this.bytes;
  }

  // To be called for every byte that is written. Returns true, once, if the supply fails within it:
  // then the byte is spoilt, and the board starts again.
  failsNow() {
    this.left -= 1;
    return this.left === -1;
  }
}
