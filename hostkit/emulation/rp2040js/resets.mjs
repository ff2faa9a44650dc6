// The reset controller of the RP2040: most peripherals are held in reset until the firmware lets them
// go, and whoever uses one before is stopped here. rp2040js lets everything work from the start.

import { BasePeripheral } from 'rp2040js';

const KEY = 0x4000c;
const RESET = 0x0;
const RESET_DONE = 0x8;
const ALL = 0x01ffffff;
const RELEASED_BY_BOOT_ROM = (1 << 6) | (1 << 9); // pins and pads of the flash

export const I2C0 = 3;
export const IO_BANK0 = 5;
export const PADS_BANK0 = 8;
export const PLL_SYS = 12;
export const TIMER = 21;
export const UART0 = 22;

const KEYS = new Map([
  [I2C0, 0x40044],
  [IO_BANK0, 0x40014],
  [PADS_BANK0, 0x4001c],
  [PLL_SYS, 0x40028],
  [TIMER, 0x40054],
  [UART0, 0x40034],
]);

class Held extends BasePeripheral {
  readUint32() {
    return this.writeUint32();
  }

  writeUint32() {
    throw new Error(`the firmware uses ${this.name} while it is held in reset`);
  }
}

export class Resets extends BasePeripheral {
  // renew: by bit, what makes a peripheral as it is after a reset; others keep what they had.
  constructor(chip, renew) {
    super(chip, 'RESETS');
    this.held = ALL & ~RELEASED_BY_BOOT_ROM;
    this.made = new Map();
    for (const [bit, key] of KEYS) {
      const present = chip.peripherals[key];
      this.made.set(bit, renew.get(bit) ?? (() => present));
      chip.peripherals[key] = new Held(chip, present.name);
    }
    chip.peripherals[KEY] = this;
  }

  readUint32(offset) {
    switch (offset) {
      case RESET:
        return this.held;
      case RESET_DONE:
        return ALL & ~this.held;
    }
    return super.readUint32(offset);
  }

  writeUint32(offset, value) {
    if (offset !== RESET) {
      super.writeUint32(offset, value);
      return;
    }
    const { peripherals } = this.rp2040;
    const before = this.held;
    this.held = value & ALL;
    for (const [bit, key] of KEYS) {
      const mask = 1 << bit;
      if ((before & ~this.held & mask) !== 0) {
        peripherals[key] = this.made.get(bit)();
      } else if ((~before & this.held & mask) !== 0) {
        peripherals[key] = new Held(this.rp2040, peripherals[key].name);
      }
    }
  }
}
