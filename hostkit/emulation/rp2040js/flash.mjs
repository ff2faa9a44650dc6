// The flash of a Pico: its content, its controller, and whether the processor can read it at all.
// rp2040js has a flash that can always be read, and a controller that keeps what is written.

import { BasePeripheral } from 'rp2040js';

const SSI_KEY = 0x18000;
const CTRLR0 = 0x00;
const CTRLR1 = 0x04;
const SSIENR = 0x08;
const SER = 0x10;
const BAUDR = 0x14;
const SPI_CTRLR0 = 0xf4;

// 32-bit frames, standard SPI, send command and address, then receive; read command 03h of 8 bits,
// address of 24 bits, both on one line.
const WANTED = [
  [SSIENR, 1],
  [SER, 1],
  [CTRLR0, (31 << 16) | (3 << 8)],
  [CTRLR1, 0],
  [SPI_CTRLR0, (0x03 << 24) | (2 << 8) | (6 << 2)],
];
const FRAME_8 = 7 << 16; // how the boot ROM talks to the flash

const NO_BYTES = new Uint8Array(0);
const NO_VIEW = new DataView(NO_BYTES.buffer);

class Controller extends BasePeripheral {
  constructor(chip, onSwitch) {
    super(chip, 'SSI');
    this.onSwitch = onSwitch;
    this.registers = new Map([[SSIENR, 0], [BAUDR, 0]]);
  }

  readUint32(offset) {
    return this.registers.get(offset) ?? super.readUint32(offset);
  }

  writeUint32(offset, value) {
    if (![...WANTED.map(([known]) => known), BAUDR].includes(offset)) {
      super.writeUint32(offset, value); // which complains
    }
    if (offset !== SSIENR && offset !== SER && this.registers.get(SSIENR) !== 0) {
      throw new Error(`register 0x${offset.toString(16)} of the SSI was set while it was on`);
    }
    this.registers.set(offset, value >>> 0);
    if (offset === SSIENR) {
      this.onSwitch(value !== 0);
    }
  }

  requireReading() {
    for (const [offset, value] of WANTED) {
      if (this.registers.get(offset) !== value) {
        throw new Error(`the loader left register 0x${offset.toString(16)} of the SSI wrong`);
      }
    }
    const divider = this.registers.get(BAUDR);
    if (divider < 2 || divider % 2 !== 0) {
      throw new Error(`the loader divides the flash clock by ${divider}: it must be even`);
    }
  }

  // Set it up for single commands, as the boot ROM does before it talks to the flash.
  talk() {
    this.registers.set(CTRLR0, FRAME_8);
    this.registers.set(SSIENR, 1);
  }
}

// What one chip sees of the flash. The content outlives it.
export class Flash {
  // content: all of its bytes, to be changed by whoever programs them.
  constructor(chip, content) {
    this.chip = chip;
    this.content = content;
    this.view = new DataView(content.buffer);
    this.selectable = true; // the controller can reach the flash
    this.controller = new Controller(chip, (on) => this.#switched(on));
    chip.peripherals[SSI_KEY] = this.controller;
    this.#hide();
  }

  get readable() {
    return this.chip.flash !== NO_BYTES;
  }

  // For the boot ROM: end reading, and talk to the flash by commands.
  command() {
    this.#hide();
    this.selectable = false;
    this.controller.talk();
  }

  // For the boot ROM: let the controller select the flash again.
  release() {
    this.selectable = true;
  }

  // To be called at the end of the loader.
  requireReadable() {
    this.controller.requireReading();
  }

  #switched(on) {
    if (!on) {
      this.#hide();
      return;
    }
    this.controller.requireReading();
    if (!this.selectable) {
      throw new Error('the flash is to be read, but its cache was not flushed');
    }
    this.chip.flash = this.content;
    this.chip.flashView = this.view;
  }

  // rp2040js then finds nothing at its addresses.
  #hide() {
    this.chip.flash = NO_BYTES;
    this.chip.flashView = NO_VIEW;
  }
}
