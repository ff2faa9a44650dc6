// Runs firmware.uf2 on an emulated RP2040; ../js/play.mjs has the options.

import { play } from '../js/play.mjs';
import { Machine } from './machine.mjs';
import { parseUf2 } from './uf2.mjs';

await play((image, sensor, onByte, nonvolatile) =>
  new Machine(parseUf2(image), sensor, onByte, nonvolatile));
