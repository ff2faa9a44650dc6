// An RP2040 with a 12 MHz crystal on rp2040js, the virtual MPU-6050 on its bus.

import { RP2040 } from 'rp2040js';

import { PAINT, Segments, stackBytes } from '../js/measure.mjs';
import { boot } from './boot.mjs';
import { SensorBus } from './bus.mjs';
import { I2C0, Resets, UART0 } from './resets.mjs';
import { Uart } from './uart.mjs';

const PATIENCE_NS = 1e7;
const RING_OSCILLATOR_HZ = 6_500_000;
const RESET_VECTOR = 0x104; // in the flash, behind the loader and the stack pointer

const TIMER_KEY = 0x40054;
const WATCHDOG_KEY = 0x40058;
const SCRATCH0 = 0x0c;
const TICK = 0x2c;
const TICK_ENABLE = 1 << 9;
const TICK_CYCLES = 0x1ff;

// The timer counts what the watchdog makes of clk_ref; that of rp2040js counts microseconds whatever
// the firmware has set.
class Tick {
  constructor(chip) {
    this.chip = chip;
    this.rate = 0;
    this.since = 0;
    this.before = 0;
  }

  get nanos() {
    return this.before + (this.chip.clock.nanos - this.since) * this.rate;
  }

  set(value) {
    this.before = this.nanos;
    this.since = this.chip.clock.nanos;
    const on = (value & TICK_ENABLE) !== 0 && (value & TICK_CYCLES) !== 0;
    this.rate = on ? this.chip.clocks.refFreq / (value & TICK_CYCLES) / 1e6 : 0;
  }
}

// Where rp2040js would only say what it does not know, the run ends.
function complain(name, message) {
  throw new Error(`${name}: ${message}`);
}

export class Machine {
  // image: flash content; onByte: called with every byte that the link sends.
  constructor(image, sensor, onByte, nonvolatile) {
    this.nonvolatile = nonvolatile;
    this.resets = 0;
    this.chip = new RP2040();
    this.chip.logger = { debug() {}, info() {}, warn: complain, error: complain };
    this.chip.flash.set(image);
    this.chip.sram.fill(PAINT);
    this.sensor = sensor;
    this.segments = new Segments();
    this.threadCycles = 0;
    this.sleepNs = 0;
    this.playedAt = Infinity;
    this.timer = this.chip.peripherals[TIMER_KEY];
    this.#wireInterrupts();
    this.bus = new SensorBus(this.chip, sensor);
    this.#wireResets(onByte);
    this.#wireTickAndMarks();
    this.#start();
  }

  get timeS() {
    return this.chip.clock.nanos / 1e9;
  }

  get busyShare() {
    return 1 - this.sleepNs / this.chip.clock.nanos;
  }

  get stackBytes() {
    return stackBytes(this.chip.sram);
  }

  // True when the table has been played and every byte is out. Firmware that polls the sensor does
  // not sleep; it is given some time to finish.
  get finished() {
    const { nanos } = this.chip.clock;
    if (this.playedAt === Infinity && !this.sensor.exhausted) {
      return false;
    }
    this.playedAt = Math.min(this.playedAt, nanos);
    return this.uart.idle && (this.chip.core.waiting || nanos - this.playedAt > PATIENCE_NS);
  }

  sensorMoved() {
    this.bus.moved();
  }

  // WFI ends with a pending interrupt even while they are masked, which is then not taken. rp2040js
  // takes it, and misses one that was pending before.
  #wireInterrupts() {
    const { core } = this.chip;
    core.setInterrupt = (irq, value) => {
      if (value) {
        core.pendingInterrupts |= 1 << irq;
        core.interruptsUpdated = true;
      } else {
        core.pendingInterrupts &= ~(1 << irq);
      }
    };
  }

  #wireResets(onByte) {
    this.uart = new Uart(this.chip, onByte);
    const renewUart = () => {
      this.uart.drop();
      this.uart = new Uart(this.chip, onByte);
      return this.uart;
    };
    new Resets(this.chip, new Map([[I2C0, () => this.bus.renew()], [UART0, renewUart]]));
  }

  // SCRATCH0 = 1 begins and SCRATCH0 = 0 ends a segment; interrupts within it are not counted.
  #wireTickAndMarks() {
    const tick = new Tick(this.chip);
    const watchdog = this.chip.peripherals[WATCHDOG_KEY];
    const write = watchdog.writeUint32.bind(watchdog);
    watchdog.writeUint32 = (offset, value) => {
      if (offset === TICK) {
        tick.set(value);
      } else if (offset === SCRATCH0) {
        this.segments.mark(value, this.threadCycles);
      }
      write(offset, value);
    };
    this.timer.clock = tick;
  }

  #start() {
    const { chip } = this;
    const follow = () => { this.nsPerCycle = 1e9 / chip.clkSys; };
    chip.clkSys = RING_OSCILLATOR_HZ;
    follow();
    chip.addClockListener(follow);
    boot(chip);
    this.begin = chip.core.PC;
    if ((this.begin | 1) !== chip.flashView.getUint32(RESET_VECTOR, true)) {
      throw new Error('the second-stage loader did not jump to the reset vector');
    }
    chip.sram.fill(PAINT); // the loader has done its work
  }

  // Jump from event to event until an interrupt wakes the processor.
  #doze(untilNs) {
    const { clock, core } = this.chip;
    while ((core.pendingInterrupts & core.enabledInterrupts) === 0) {
      if (clock.nextAlarm === null) {
        throw new Error(`the firmware sleeps for ever, at ${core.PC.toString(16)}`);
      }
      const stepNs = Math.min(clock.nanosToNextAlarm, untilNs - clock.nanos);
      clock.tick(stepNs);
      this.sleepNs += stepNs;
      if (clock.nanos >= untilNs || this.finished) {
        return;
      }
    }
    core.waiting = false;
  }

  // Run until a time or until the machine has finished.
  runUntil(timeS) {
    const { clock, core } = this.chip;
    const untilNs = timeS * 1e9;
    while (clock.nanos < untilNs && !(core.waiting && this.finished)) {
      if (core.waiting) {
        this.#doze(untilNs);
        continue;
      }
      const inThread = core.IPSR === 0;
      const cycles = core.executeInstruction();
      if (inThread && core.IPSR === 0) {
        this.threadCycles += cycles;
      }
      clock.tick(cycles * this.nsPerCycle);
      if (core.PC === this.begin) {
        throw new Error(`the firmware jumped to its start after ${this.timeS.toFixed(3)} s`);
      }
    }
  }
}
