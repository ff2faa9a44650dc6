// The EEPROM of an emulated ATmega328P, whose content outlives the machine and whose supply may fail.

import avr8js from 'avr8js';

const { AVREEPROM, eepromConfig } = avr8js;

export const EEPROM_BYTES = 1024;
const HALF_PROGRAMMED = 0x5a; // what the bits of a spoilt byte differ in from what it should be

export class Eeprom {
  // nonvolatile: see ../js/nonvolatile.mjs; bytes: its content; onPowerCut: called if the supply
  // fails within a byte.
  constructor(cpu, nonvolatile, bytes, onPowerCut) {
    const backend = {
      readMemory: (address) => {
        if (cpu.cycles < this.peripheral.writeCompleteCycles) {
          throw new Error('the firmware reads the EEPROM while a byte is being written');
        }
        return bytes[address % EEPROM_BYTES];
      },
      eraseMemory: (address) => {
        bytes[address % EEPROM_BYTES] = 0xff;
      },
      writeMemory: (address, value) => {
        bytes[address % EEPROM_BYTES] &= value;
        if (nonvolatile.failsNow()) {
          bytes[address % EEPROM_BYTES] ^= HALF_PROGRAMMED;
          cpu.addClockEvent(onPowerCut, eepromConfig.writeCycles);
        }
      },
    };
    this.peripheral = new AVREEPROM(cpu, backend);
  }
}
