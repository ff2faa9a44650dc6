// The boot ROM of an RP2040 as far as the firmware calls it: the functions that change the flash, and
// the table in which they are looked up. Each is a stub in the ROM that ends up here.

const POINTERS = 0x14;
const FUNCTION_TABLE = 0x100;
const DATA_TABLE = 0x140;
const STUBS = 0x180;
const STUB_BYTES = 4;
const BREAKPOINT = 0xbe00;
const RETURN = 0x4770; // bx lr

const SECTOR_BYTES = 4096;
const PAGE_BYTES = 256;
const ERASE_NS = 45e6; // W25Q16JV: typical; 400 ms at most
const PROGRAM_NS = 0.4e6; // typical; 3 ms at most
const FLASH_BYTES = 2 * 1024 * 1024;
const STORE_BYTES = 2 * SECTOR_BYTES;

export const STORE_START = FLASH_BYTES - STORE_BYTES;
export { STORE_BYTES };

const ERASED = 0xff;
const SPOILT = 0x5a; // what a broken-off erase leaves of a byte

export class BootRom {
  // board: wait(ns) lets time pass and returns false if the chip is reset meanwhile; supplyFails()
  // resets it; nonvolatile is the content of the store.
  constructor(chip, flash, board) {
    this.chip = chip;
    this.flash = flash;
    this.board = board;
    this.connected = false;
    const functions = [
      ['IF', () => this.#connect()],
      ['EX', () => this.#leaveReading()],
      ['RE', (offset, count) => this.#erase(offset, count)],
      ['RP', (offset, from, count) => this.#program(offset, from, count)],
      ['FC', () => this.#flush()],
    ];
    this.calls = [(table, code) => this.#lookUp(table, code), ...functions.map(([, call]) => call)];
    this.#fill(functions.map(([name]) => name));
    chip.onBreak = (number) => this.#call(number);
  }

  #fill(names) {
    const rom = new DataView(this.chip.bootrom.buffer);
    const put = (address, half) => rom.setUint16(address, half, true);
    const stub = (number) => (STUBS + STUB_BYTES * number) | 1;
    [FUNCTION_TABLE, DATA_TABLE, stub(0)].forEach((pointer, i) => put(POINTERS + 2 * i, pointer));
    names.forEach((name, i) => {
      put(FUNCTION_TABLE + 4 * i, name.charCodeAt(0) | (name.charCodeAt(1) << 8));
      put(FUNCTION_TABLE + 4 * i + 2, stub(i + 1));
    });
    this.calls.forEach((_, number) => {
      put(STUBS + STUB_BYTES * number, BREAKPOINT | number);
      put(STUBS + STUB_BYTES * number + 2, RETURN);
    });
  }

  #call(number) {
    const { core } = this.chip;
    const address = core.PC - 2;
    if (address !== STUBS + STUB_BYTES * number || number >= this.calls.length) {
      throw new Error(`the firmware met a breakpoint at 0x${address.toString(16)}`);
    }
    core.registers[0] = this.calls[number](...core.registers.subarray(0, 3)) ?? 0;
  }

  // Entries are a code and a pointer of 16 bits each; a code of 0 ends them.
  #lookUp(table, code) {
    for (let at = table; this.chip.readUint16(at) !== 0; at += 4) {
      if (this.chip.readUint16(at) === code) {
        return this.chip.readUint16(at + 2);
      }
    }
    return 0;
  }

  #connect() {
    this.connected = true;
  }

  #leaveReading() {
    if (!this.connected) {
      throw new Error('the flash is to take commands, but it was not connected');
    }
    this.flash.command();
  }

  #flush() {
    this.connected = false;
    this.flash.release();
  }

  #requireRange(what, offset, count, unit) {
    if (this.flash.readable || !this.connected) {
      throw new Error(`the firmware ${what} the flash while it is set up for reading`);
    }
    if (offset % unit !== 0 || count % unit !== 0 || count === 0) {
      throw new Error(`the firmware ${what} ${count} bytes at 0x${offset.toString(16)} of the ` +
        `flash: both must be multiples of ${unit}`);
    }
    if (offset < STORE_START || offset + count > FLASH_BYTES) {
      throw new Error(`the firmware ${what} 0x${offset.toString(16)} of the flash, which is not ` +
        'in its store');
    }
  }

  #set(offset, value) {
    this.flash.content[offset] = value;
    this.board.nonvolatile.bytes[offset - STORE_START] = value;
  }

  #blank(from, to) {
    for (let offset = from; offset < to; offset++) {
      this.#set(offset, ERASED);
    }
  }

  // An erase that is broken off has done half of the sector. To the supply it is one byte.
  #erase(offset, count) {
    const { board } = this;
    this.#requireRange('erases', offset, count, SECTOR_BYTES);
    for (let sector = offset; sector < offset + count; sector += SECTOR_BYTES) {
      const middle = sector + SECTOR_BYTES / 2;
      const whole = board.wait(ERASE_NS / 2);
      this.#blank(sector, middle);
      if (board.nonvolatile.failsNow()) {
        this.#set(middle, SPOILT);
        board.supplyFails();
        return;
      }
      if (!whole || !board.wait(ERASE_NS / 2)) {
        return;
      }
      this.#blank(middle, sector + SECTOR_BYTES);
    }
  }

  // Programming clears bits, one byte after the other; one that has none to clear costs nothing.
  #program(offset, from, count) {
    const { board, chip, flash } = this;
    this.#requireRange('programs', offset, count, PAGE_BYTES);
    for (let i = 0; i < count; i++) {
      const before = flash.content[offset + i];
      const after = before & chip.readUint8(from + i);
      if (i % PAGE_BYTES === 0 && !board.wait(PROGRAM_NS)) {
        return;
      }
      if (after !== before && board.nonvolatile.failsNow()) {
        const toClear = before & ~after;
        this.#set(offset + i, after | (toClear & -toClear)); // the lowest bit was not cleared
        board.supplyFails();
        return;
      }
      this.#set(offset + i, after);
    }
  }
}
