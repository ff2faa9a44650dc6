// Reads a UF2 file, what a Pico's USB drive takes, into the bytes of the flash.

const BLOCK_BYTES = 512;
const HEADER_BYTES = 32;
const PAYLOAD_BYTES = 256;
const MAGIC = [[0, 0x0a324655], [4, 0x9e5d5157], [BLOCK_BYTES - 4, 0x0ab16f30]];
const FAMILY_RP2040 = 0xe48bff56;
const HAS_FAMILY = 0x2000;
const FLASH_START = 0x10000000;

// The boot ROM takes blocks in any order, but each in its place.
function requireBlock(block, number, blocks) {
  const wanted = [
    ...MAGIC,
    [8, HAS_FAMILY],
    [12, FLASH_START + number * PAYLOAD_BYTES],
    [16, PAYLOAD_BYTES],
    [20, number],
    [24, blocks],
    [28, FAMILY_RP2040],
  ];
  for (const [offset, value] of wanted) {
    if (block.readUInt32LE(offset) !== value) {
      throw new Error(`block ${number} of the UF2 file is damaged at byte ${offset}`);
    }
  }
}

export function parseUf2(file) {
  const blocks = file.length / BLOCK_BYTES;
  if (blocks === 0 || !Number.isInteger(blocks)) {
    throw new Error(`a UF2 file of ${file.length} bytes is damaged: blocks have ${BLOCK_BYTES}`);
  }
  const image = new Uint8Array(blocks * PAYLOAD_BYTES);
  for (let number = 0; number < blocks; number++) {
    const block = file.subarray(number * BLOCK_BYTES, (number + 1) * BLOCK_BYTES);
    requireBlock(block, number, blocks);
    const payload = block.subarray(HEADER_BYTES, HEADER_BYTES + PAYLOAD_BYTES);
    image.set(payload, number * PAYLOAD_BYTES);
  }
  return image;
}
