// Runs an image on the emulator of the board, without a sensor, and writes what simavr_cycles.c does.
//
//   node avr8js_cycles.mjs FOLDER FIRMWARE.HEX LIMIT, the seconds after which it gives up
//
// FOLDER: where the modules of the emulators are.

import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [folder, image, limitS] = process.argv.slice(2);
const module = (name) => import(pathToFileURL(`${folder}/${name}`));
const { Machine } = await module('avr8js/machine.mjs');
const { parseIntelHex } = await module('avr8js/intel_hex.mjs');
const { NonVolatile } = await module('js/nonvolatile.mjs');

const noSensor = {
  advance() {}, clock() {}, stop() {}, intPin: false, sdaLow: false, nextEventNs: Infinity,
  exhausted: false,
};
const lines = [];
const store = new NonVolatile(Buffer.alloc(0), Infinity);
const bytes = parseIntelHex(readFileSync(image, 'latin1'), 32768);
const machine = new Machine(bytes, noSensor, (byte) => lines.push(`byte ${byte}`), store);
let begun = 0;
machine.segments.mark = (value, cycles) => {
  if (value !== 0) {
    begun = cycles;
  } else {
    lines.push(`cycles ${cycles - begun}`);
  }
};
let ended = false;
try {
  machine.runUntil(Number(limitS));
} catch (error) {
  ended = error.message.includes('sleeps for ever'); // how a bench says that it is done
}
process.stdout.write(`${lines.join('\n')}\n`);
process.exitCode = ended ? 0 : 1;
