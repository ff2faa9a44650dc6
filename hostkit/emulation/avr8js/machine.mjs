// An ATmega328P at 16 MHz on avr8js with the virtual MPU-6050 on its bus, INT on PD2.

import avr8js from 'avr8js';

import { PAINT, Segments, stackBytes } from '../js/measure.mjs';
import { Bus } from './bus.mjs';
import { EEPROM_BYTES, Eeprom } from './eeprom.mjs';
import { Link } from './link.mjs';
import { POWER_ON, WATCHDOG, resetFlags, watched, wireResets } from './resets.mjs';

const { AVRTimer, CPU, avrInstruction, timer1Config } = avr8js;

const CLOCK_HZ = 16_000_000;
const NS_PER_CYCLE = 1e9 / CLOCK_HZ;
const PATIENCE_CYCLES = CLOCK_HZ / 100;
const FLASH_BYTES = 32768;
const SRAM_BYTES = 2048;
const SRAM_START = 0x100;
const START_UP_CYCLES = 16_384 + 0.065 * CLOCK_HZ; // after every reset, with the fuses of an Uno
const LOST = 0xa7; // what the memory holds when the supply comes back

const SLEEP = 0x9588;
const RETI = 0x9518;
const SMCR = 0x53;
const SREG = 0x5f;
const SREG_I = 0x80;
const SLEEP_ENABLE = 0x01;
const GPIOR0 = 0x3e;
const TIMER1_COMPARE_INTERRUPTS = 0x26;

export class Machine {
  // image: flash content; onByte: called with every byte that the link sends; nonvolatile: what the
  // EEPROM holds.
  constructor(image, sensor, onByte, nonvolatile) {
    this.program = new Uint16Array(FLASH_BYTES / 2);
    new Uint8Array(this.program.buffer).set(image);
    this.sensor = sensor;
    this.onByte = onByte;
    this.nonvolatile = nonvolatile;
    this.eeprom = nonvolatile.mount(EEPROM_BYTES);
    this.clockHz = CLOCK_HZ;
    this.segments = new Segments();
    this.resets = 0;
    this.sleepCycles = 0;
    this.interruptCycles = 0;
    this.deepestStack = 0;
    this.#build(POWER_ON, 0);
    this.#paint(PAINT);
    this.sensorMoved();
  }

  // Make a processor with its peripherals as they are after a reset. flags: of MCUSR.
  #build(flags, cycles) {
    this.cpu = new CPU(this.program, SRAM_BYTES);
    this.cpu.cycles = cycles;
    this.resetFlags = 0; // of a reset that is to come
    this.sleeping = false;
    this.interruptDepth = 0;
    this.playedAt = Infinity;
    this.sensorEventAt = Infinity;
    wireResets(this.cpu, CLOCK_HZ, flags, () => { this.resetFlags = WATCHDOG; });
    this.#wireClock();
    this.link = new Link(this.cpu, CLOCK_HZ, this.onByte);
    this.bus = new Bus(this);
    const { nonvolatile, eeprom } = this;
    new Eeprom(this.cpu, nonvolatile, eeprom, () => { this.resetFlags = POWER_ON; });
    this.#wireMarks();
  }

  // Start again. The watchdog leaves the memory as it is; after the supply has failed nobody knows
  // what it holds, and the sensor starts again as well.
  #startOver() {
    const { data, cycles } = this.cpu;
    const flags = this.resetFlags;
    const powered = flags !== POWER_ON;
    this.deepestStack = this.stackBytes;
    this.#build(powered ? resetFlags(this.cpu) | flags : flags, cycles + START_UP_CYCLES);
    this.cpu.data.set(data.subarray(SRAM_START), SRAM_START);
    if (!powered) {
      this.#paint(LOST);
      this.sensor.powerCycle();
    }
    this.resets += 1;
    this.segments.beginning = null;
    this.sleepCycles += START_UP_CYCLES;
    this.sensorMoved();
  }

  get nowNs() {
    return this.cpu.cycles * NS_PER_CYCLE;
  }

  get timeS() {
    return this.cpu.cycles / CLOCK_HZ;
  }

  // True when the table has been played and every byte is out. Firmware that polls the sensor does
  // not sleep; it is given some time to finish.
  get finished() {
    const { cycles } = this.cpu;
    if (!this.sensor.exhausted) {
      this.playedAt = Infinity;
      return false;
    }
    this.playedAt = Math.min(this.playedAt, cycles);
    const done = this.sleeping || cycles - this.playedAt > PATIENCE_CYCLES;
    return done && this.link.idle;
  }

  get busyShare() {
    return 1 - this.sleepCycles / this.cpu.cycles;
  }

  get stackBytes() {
    return Math.max(this.deepestStack, stackBytes(this.cpu.data.subarray(SRAM_START), this.paint));
  }

  #paint(value) {
    this.paint = value;
    this.cpu.data.fill(value, SRAM_START);
  }

  receive(byte) {
    this.link.receive(byte);
  }

  // avr8js wakes the timer at every tick. Nobody sees its count between reads, which bring it up to
  // date, so unless compare interrupts are on it may sleep until it overflows.
  #wireClock() {
    const { cpu } = this;
    const timer = new AVRTimer(cpu, timer1Config);
    const add = cpu.addClockEvent.bind(cpu);
    cpu.addClockEvent = (callback, cycles) => {
      const compares = cpu.data[timer1Config.TIMSK] & TIMER1_COMPARE_INTERRUPTS;
      if (callback === timer.count && cycles > 0 && timer.divider && !compares) {
        cycles += (0xffff - timer.debugTCNT) * timer.divider;
      }
      return add(callback, cycles);
    };
  }

  // GPIOR0 = 1 begins and GPIOR0 = 0 ends a segment; interrupts within it are not counted.
  #wireMarks() {
    const { cpu, segments } = this;
    cpu.writeHooks[GPIOR0] = (value) => {
      segments.mark(value, cpu.cycles - this.interruptCycles);
      return false;
    };
  }

  // Bring the sensor up to date, drive its pins, and come back when it changes by itself. An event
  // that was planned and is not wanted any more is let pass: taking the event that avr8js is just
  // carrying out from its list would lose others.
  sensorMoved() {
    const { cpu, sensor } = this;
    sensor.advance(this.nowNs);
    this.bus.show();
    const at = Math.ceil(sensor.nextEventNs / NS_PER_CYCLE);
    if (at === this.sensorEventAt) {
      return;
    }
    this.sensorEventAt = at;
    if (at !== Infinity) {
      cpu.addClockEvent(() => {
        if (this.sensorEventAt === at) {
          this.sensorEventAt = null;
          this.sensorMoved();
        }
      }, at - cpu.cycles);
    }
  }

  // Let events happen and interrupts begin.
  #tick() {
    const { cpu } = this;
    const { pc, cycles } = cpu;
    cpu.tick();
    if (cpu.pc !== pc) {
      this.sleeping = false;
      if (this.interruptDepth++ === 0) {
        this.interruptBegin = cycles;
      }
    }
  }

  #leaveInterrupt() {
    if (--this.interruptDepth === 0) {
      this.interruptCycles += this.cpu.cycles - this.interruptBegin;
    }
  }

  #skipTo(cycles) {
    const skipped = Math.max(cycles - this.cpu.cycles, 0);
    this.cpu.cycles += skipped;
    this.sleepCycles += skipped;
  }

  // Jump from event to event until an interrupt wakes the processor.
  #doze(untilCycles) {
    const { cpu } = this;
    if (cpu.nextInterrupt >= 0) {
      this.#tick();
    }
    while (this.sleeping && !this.finished && this.resetFlags === 0) {
      const event = cpu.nextClockEvent;
      if (event === null || !(cpu.interruptsEnabled || watched(cpu))) {
        throw new Error(`the firmware sleeps for ever, at word ${cpu.pc} of flash`);
      }
      this.#skipTo(Math.min(event.cycles, untilCycles));
      if (event.cycles > untilCycles) {
        return;
      }
      this.#tick();
    }
  }

  // Run until a time or until the machine has finished.
  runUntil(timeS) {
    const untilCycles = Math.ceil(timeS * CLOCK_HZ);
    while (this.cpu.cycles < untilCycles && !(this.sleeping && this.finished)) {
      if (this.sleeping) {
        this.#doze(untilCycles);
      } else {
        this.#run(untilCycles);
      }
      if (this.resetFlags !== 0) {
        this.#startOver();
      }
    }
  }

  // Run until the processor sleeps or is reset. Where an instruction sets the interrupt flag, be it
  // SEI, RETI or OUT to SREG, the real part runs one more before any interrupt. Sleeping without a
  // race rests on that, and so does the compiler when it moves the stack pointer.
  #run(untilCycles) {
    const { cpu } = this;
    const { data, progMem } = cpu;
    while (cpu.cycles < untilCycles) {
      const opcode = progMem[cpu.pc];
      const masked = (data[SREG] & SREG_I) === 0;
      avrInstruction(cpu);
      if (cpu.pc === 0) {
        throw new Error(`the firmware jumped to its start after ${this.timeS.toFixed(3)} s`);
      }
      if (opcode === RETI) {
        this.#leaveInterrupt();
      } else if (opcode === SLEEP && (data[SMCR] & SLEEP_ENABLE) !== 0) {
        this.sleeping = true;
        return;
      }
      if (masked && (data[SREG] & SREG_I) !== 0) {
        continue;
      }
      const event = cpu.nextClockEvent;
      if (cpu.nextInterrupt >= 0 || (event !== null && event.cycles <= cpu.cycles)) {
        this.#tick();
        if (this.resetFlags !== 0) {
          return;
        }
      }
    }
  }
}
