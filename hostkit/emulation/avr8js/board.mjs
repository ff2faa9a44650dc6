// Runs firmware.hex on an emulated ATmega328P; ../js/play.mjs has the options.

import { play } from '../js/play.mjs';
import { parseIntelHex } from './intel_hex.mjs';
import { Machine } from './machine.mjs';

const FLASH_BYTES = 32768;

await play((image, sensor, onByte, nonvolatile) =>
  new Machine(parseIntelHex(image.toString('latin1'), FLASH_BYTES), sensor, onByte, nonvolatile));
