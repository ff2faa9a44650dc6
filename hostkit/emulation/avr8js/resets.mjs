// Why an emulated ATmega328P starts, and its watchdog: MCUSR and WDTCSR as the data sheet has them.

import avr8js from 'avr8js';

const { AVRClock, AVRWatchdog, watchdogConfig } = avr8js;
const { MCUSR, WDTCSR } = watchdogConfig;

export const POWER_ON = 0x01; // flags of MCUSR
export const WATCHDOG = 0x08;

const WDCE = 0x10;
const WDE = 0x08;

// The flags that have gathered in MCUSR.
export function resetFlags(cpu) {
  return cpu.data[MCUSR];
}

// Whether the watchdog will end a sleep.
export function watched(cpu) {
  return (cpu.data[WDTCSR] & WDE) !== 0;
}

// Give a new processor its reset flags and its watchdog. flags: of MCUSR; onBite: called when the
// watchdog resets the processor.
export function wireResets(cpu, clockHz, flags, onBite) {
  cpu.data[MCUSR] = flags;
  cpu.writeHooks[MCUSR] = (value, old) => {
    cpu.data[MCUSR] = old & value; // writing 1 sets nothing
    return true;
  };
  cpu.reset = onBite; // what avr8js calls; it would leave the peripherals as they were
  new AVRWatchdog(cpu, watchdogConfig, new AVRClock(cpu, clockHz));
  keepRunning(cpu);
}

// While WDRF is set the watchdog cannot be switched off, and it begins with its shortest time.
function keepRunning(cpu) {
  const write = cpu.writeHooks[WDTCSR];
  cpu.writeHooks[WDTCSR] = (value, ...rest) => {
    const forced = (cpu.data[MCUSR] & WATCHDOG) !== 0 && (value & WDCE) === 0 ? WDE : 0;
    return write(value | forced, ...rest);
  };
  if ((cpu.data[MCUSR] & WATCHDOG) !== 0) {
    cpu.writeData(WDTCSR, WDCE | WDE);
    cpu.writeData(WDTCSR, WDE);
  }
}
