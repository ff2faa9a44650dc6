// Reads an Intel HEX file into bytes.

const DATA = 0;
const END = 1;

export function parseIntelHex(text, size) {
  const image = new Uint8Array(size).fill(0xff);
  for (const line of text.split(/\r?\n/)) {
    if (line === '') {
      continue;
    }
    const record = Buffer.from(line.slice(1), 'hex');
    const sum = record.reduce((a, b) => (a + b) & 0xff, 0);
    if (line[0] !== ':' || record.length !== record[0] + 5 || sum !== 0) {
      throw new Error(`a line of the HEX file is damaged: ${line.slice(0, 40)}`);
    }
    const address = record.readUInt16BE(1);
    if (record[3] === END) {
      break;
    }
    if (record[3] === DATA) {
      if (address + record[0] > size) {
        throw new Error(`the HEX file reaches beyond ${size} bytes of flash`);
      }
      image.set(record.subarray(4, 4 + record[0]), address);
    }
  }
  return image;
}
