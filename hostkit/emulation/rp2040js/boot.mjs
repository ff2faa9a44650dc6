// What the boot ROM of an RP2040 does with a flash image when the chip starts.

const LOADER_BYTES = 256;
const LOADER_ADDRESS = 0x20041f00;
const FLASH_START = 0x10000000;
const FLASH_END = 0x11000000;
const STEPS_MAX = 10000;

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
export function boot(chip, flash) {
  const loader = flash.content.subarray(0, LOADER_BYTES);
  const { core } = chip;
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
  flash.requireReadable();
}
