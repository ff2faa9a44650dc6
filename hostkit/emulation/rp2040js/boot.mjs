// What the boot ROM of an RP2040 does with a flash image, and the flash controller it leaves to the
// second-stage loader; rp2040js has neither.

import { BasePeripheral } from 'rp2040js';

const LOADER_BYTES = 256;
const LOADER_ADDRESS = 0x20041f00;
const FLASH_START = 0x10000000;
const FLASH_END = 0x11000000;
const STEPS_MAX = 10000;

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

class FlashController extends BasePeripheral {
  constructor(chip) {
    super(chip, 'SSI');
    this.registers = new Map([[SSIENR, 0], [BAUDR, 0]]);
  }

  writeUint32(offset, value) {
    if (![...WANTED.map(([known]) => known), BAUDR].includes(offset)) {
      super.writeUint32(offset, value); // which complains
    }
    if (offset !== SSIENR && offset !== SER && this.registers.get(SSIENR) !== 0) {
      throw new Error(`register 0x${offset.toString(16)} of the SSI was set while it was on`);
    }
    this.registers.set(offset, value >>> 0);
  }

  requireReadable() {
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
}

// CRC-32 of the boot ROM: most significant bit first, begun with ones, not inverted.
function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte << 24;
    for (let bit = 0; bit < 8; bit++) {
      crc = crc < 0 ? (crc << 1) ^ 0x04c11db7 : crc << 1;
    }
  }
  return crc >>> 0;
}

function requireChecksum(loader) {
  const found = Buffer.from(loader).readUInt32LE(LOADER_BYTES - 4);
  const wanted = crc32(loader.subarray(0, LOADER_BYTES - 4));
  if (found !== wanted) {
    throw new Error(`the boot ROM refuses the image: its loader has the CRC ${found.toString(16)}, ` +
      `not ${wanted.toString(16)}; it is damaged`);
  }
}

// Start the image in the flash: copy its loader to the RAM, run it, and come back when it has jumped
// into the flash.
export function boot(chip) {
  const controller = new FlashController(chip);
  const loader = chip.flash.subarray(0, LOADER_BYTES);
  const { core } = chip;
  chip.peripherals[SSI_KEY] = controller;
  requireChecksum(loader);
  for (let i = 0; i < LOADER_BYTES; i++) {
    chip.writeUint8(LOADER_ADDRESS + i, loader[i]);
  }
  core.SP = LOADER_ADDRESS;
  core.LR = 0;
  core.PC = LOADER_ADDRESS;
  for (let steps = 0; core.PC < FLASH_START || core.PC >= FLASH_END; steps++) {
    if (steps === STEPS_MAX) {
      throw new Error('the second-stage loader does not come to an end');
    }
    core.executeInstruction();
  }
  controller.requireReadable();
}
