// An RP2040 with a 12 MHz crystal on rp2040js, the virtual MPU-6050 on its bus. A reset makes a new
// chip; time, flash, sensor and what is measured go on.

import { RP2040 } from 'rp2040js';

import { PAINT, Segments, stackBytes } from '../js/measure.mjs';
import { boot } from './boot.mjs';
import { BootRom, STORE_BYTES, STORE_START } from './boot_rom.mjs';
import { SensorBus } from './bus.mjs';
import { Flash } from './flash.mjs';
import { I2C0, Resets, UART0 } from './resets.mjs';
import { Uart } from './uart.mjs';
import { Watchdog, powerUpState } from './watchdog.mjs';
import { Wire } from './wire.mjs';

const PATIENCE_NS = 1e7;
const RING_OSCILLATOR_HZ = 6_500_000;
const RESET_VECTOR = 0x104; // in the flash, behind the loader and the stack pointer
const LOADER_BYTES = 256; // at the end of the RAM
const WATCHDOG = 'watchdog';
const SUPPLY = 'supply';

export class Machine {
  // image: flash content; onByte: called with every byte that the link sends.
  constructor(image, sensor, onByte, nonvolatile) {
    this.nonvolatile = nonvolatile;
    this.onByte = onByte;
    this.sensor = sensor;
    this.segments = new Segments();
    this.threadCycles = 0;
    this.sleepNs = 0;
    this.playedAt = Infinity;
    this.resets = 0;
    this.resetBy = null;
    const chip = new RP2040();
    this.clock = chip.clock;
    this.content = chip.flash;
    this.content.set(image);
    this.content.set(nonvolatile.mount(STORE_BYTES), STORE_START);
    this.memory = chip.sram;
    this.#powerUp();
    this.#start(chip);
  }

  get timeS() {
    return this.clock.nanos / 1e9;
  }

  get busyShare() {
    return 1 - this.sleepNs / this.clock.nanos;
  }

  get stackBytes() {
    return Math.max(this.deepestStack, stackBytes(this.memory));
  }

  // True when the table has been played and every byte is out. Firmware that polls the sensor does
  // not sleep; it is given some time to finish.
  get finished() {
    const { nanos } = this.clock;
    if (this.playedAt === Infinity && !this.sensor.exhausted) {
      return false;
    }
    this.playedAt = Math.min(this.playedAt, nanos);
    const quiet = this.resetBy === null && this.uart.idle && this.wire.idle;
    return quiet && (this.chip.core.waiting || nanos - this.playedAt > PATIENCE_NS);
  }

  sensorMoved() {
    this.bus.moved();
  }

  // The byte comes in when those before it have.
  receive(byte) {
    this.wire.send(byte);
  }

  // Let time pass while the processor does nothing. False if the chip is to be reset by then.
  wait(ns) {
    this.clock.tick(ns);
    return this.resetBy === null;
  }

  supplyFails() {
    this.resetBy = SUPPLY;
  }

  #powerUp() {
    this.deepestStack = this.lasting === undefined ? 0 : this.stackBytes;
    this.memory.fill(PAINT);
    this.lasting = powerUpState();
  }

  #restart() {
    this.resets += 1;
    this.clock.nextAlarm = null; // all of them are the old chip's
    if (this.resetBy === SUPPLY) {
      this.#powerUp();
      this.sensor.powerCycle();
    }
    this.resetBy = null;
    this.segments.beginning = null;
    this.#start(new RP2040(this.clock));
  }

  #start(chip) {
    this.chip = chip;
    chip.sram = this.memory;
    chip.sramView = new DataView(this.memory.buffer);
    this.flash = new Flash(chip, this.content);
    const complain = (name, message) => this.#complain(name, message);
    chip.logger = { debug() {}, info() {}, warn: complain, error: complain };
    this.#wireInterrupts();
    this.bus = new SensorBus(chip, this.sensor);
    new Watchdog(chip, this.lasting, {
      onReset: () => { this.resetBy ??= WATCHDOG; },
      onMark: (value) => this.segments.mark(value, this.threadCycles),
    });
    this.#wireResets();
    this.wire = new Wire(this.clock, () => this.uart, this.wire);
    new BootRom(chip, this.flash, this);
    this.#boot();
  }

  // Where rp2040js would only say what it does not know, the run ends.
  #complain(name, message) {
    const why = this.flash.readable ? '' : ', while the flash cannot be read';
    throw new Error(`${name}: ${message}${why}`);
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

  #wireResets() {
    const { chip, onByte } = this;
    this.uart = new Uart(chip, onByte);
    const renewUart = () => {
      this.uart.drop();
      this.uart = new Uart(chip, onByte);
      return this.uart;
    };
    new Resets(chip, new Map([[I2C0, () => this.bus.renew()], [UART0, renewUart]]));
  }

  #boot() {
    const { chip } = this;
    const loaderPlace = this.memory.slice(-LOADER_BYTES);
    const follow = () => { this.nsPerCycle = 1e9 / chip.clkSys; };
    chip.clkSys = RING_OSCILLATOR_HZ;
    follow();
    chip.addClockListener(follow);
    boot(chip, this.flash);
    this.begin = chip.core.PC;
    if ((this.begin | 1) !== chip.flashView.getUint32(RESET_VECTOR, true)) {
      throw new Error('the second-stage loader did not jump to the reset vector');
    }
    this.memory.set(loaderPlace, this.memory.length - LOADER_BYTES); // it is no stack in use
  }

  // Jump from event to event until an interrupt wakes the processor.
  #doze(untilNs) {
    const { clock } = this;
    const { core } = this.chip;
    while ((core.pendingInterrupts & core.enabledInterrupts) === 0) {
      if (clock.nextAlarm === null) {
        throw new Error(`the firmware sleeps for ever, at ${core.PC.toString(16)}`);
      }
      const stepNs = Math.min(clock.nanosToNextAlarm, untilNs - clock.nanos);
      clock.tick(stepNs);
      this.sleepNs += stepNs;
      if (clock.nanos >= untilNs || this.resetBy !== null || this.finished) {
        return;
      }
    }
    core.waiting = false;
  }

  // Run one chip until a time, until it is to be reset, or until the machine has finished.
  #run(untilNs) {
    const { clock } = this;
    const { core } = this.chip;
    while (clock.nanos < untilNs && this.resetBy === null) {
      if (core.waiting) {
        if (this.finished) {
          return;
        }
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

  // Run until a time or until the machine has finished.
  runUntil(timeS) {
    const untilNs = timeS * 1e9;
    while (this.clock.nanos < untilNs && !(this.chip.core.waiting && this.finished)) {
      if (this.resetBy !== null) {
        this.#restart();
      }
      this.#run(untilNs);
    }
  }
}
