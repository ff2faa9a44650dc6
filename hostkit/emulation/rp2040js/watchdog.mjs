// The watchdog of an RP2040: it resets the chip, its tick drives the timer, and its scratch registers
// outlive a reset. That of rp2040js only says that it would, and ticks whatever is set.

import { BasePeripheral } from 'rp2040js';

const KEY = 0x40058;
const TIMER_KEY = 0x40054;
const PSM_KEY = 0x40010;
const CHIP_RESET_KEY = 0x40064;

const CTRL = 0x00;
const LOAD = 0x04;
const REASON = 0x08;
const SCRATCH0 = 0x0c;
const SCRATCH7 = 0x28;
const TICK = 0x2c;
const TRIGGER = 1 << 31;
const ENABLE = 1 << 30;
const PAUSE = 7 << 24;
const COUNTS = 0xffffff;
const TICK_ENABLE = 1 << 9;
const TICK_RUNNING = 1 << 10;
const TICK_CYCLES = 0x1ff;
const COUNTS_PER_TICK = 2; // erratum RP2040-E1
const BY_TIME = 1;
const BY_TRIGGER = 2;
const ALL_BUT_OSCILLATORS = 0x1fffc;

const CHIP_RESET = 0x08;
const HAD_POWER_UP = 1 << 8;

// What outlives a reset by the watchdog, as it is after power-up.
export function powerUpState() {
  return { scratch: new Uint32Array(8), reason: 0 };
}

// The timer counts what the watchdog makes of clk_ref; that of rp2040js counts microseconds whatever
// the firmware has set.
class Tick {
  constructor(chip) {
    this.chip = chip;
    this.value = 0;
    this.rate = 0; // ticks per microsecond
    this.since = 0;
    this.before = 0;
  }

  get nanos() {
    return this.before + (this.chip.clock.nanos - this.since) * this.rate;
  }

  set(value) {
    this.before = this.nanos;
    this.since = this.chip.clock.nanos;
    this.value = value & (TICK_ENABLE | TICK_CYCLES);
    const on = (value & TICK_ENABLE) !== 0 && (value & TICK_CYCLES) !== 0;
    this.rate = on ? this.chip.clocks.refFreq / (value & TICK_CYCLES) / 1e6 : 0;
  }
}

class ChipReset extends BasePeripheral {
  readUint32(offset) {
    return offset === CHIP_RESET ? HAD_POWER_UP : super.readUint32(offset);
  }
}

export class Watchdog extends BasePeripheral {
  // lasting: of powerUpState(); onReset: called when the chip is to start again; onMark: called with
  // what is written to SCRATCH0.
  constructor(chip, lasting, { onReset, onMark }) {
    super(chip, 'WATCHDOG');
    this.lasting = lasting;
    this.onReset = onReset;
    this.onMark = onMark;
    this.tick = new Tick(chip);
    this.control = 0;
    this.left = 0;
    this.since = 0;
    this.alarm = chip.clock.createAlarm(() => this.#fire(BY_TIME));
    chip.peripherals[KEY] = this;
    chip.peripherals[TIMER_KEY].clock = this.tick;
    chip.peripherals[CHIP_RESET_KEY] = new ChipReset(chip, 'CHIP_RESET');
  }

  get #counting() {
    return (this.control & ENABLE) !== 0 && this.tick.rate > 0;
  }

  get #countsNow() {
    const passed = this.#counting
      ? ((this.rp2040.clock.nanos - this.since) / 1000) * this.tick.rate * COUNTS_PER_TICK : 0;
    return Math.max(0, this.left - passed);
  }

  // Bring the count up to date, make a change, and find out when it will be over.
  #change(action) {
    const { clock } = this.rp2040;
    this.left = this.#countsNow;
    this.since = clock.nanos;
    action();
    this.alarm.cancel();
    if (this.#counting) {
      this.alarm.schedule((this.left / (this.tick.rate * COUNTS_PER_TICK)) * 1000);
    }
  }

  #fire(reason) {
    const selected = this.rp2040.peripherals[PSM_KEY].wdsel;
    if (selected !== ALL_BUT_OSCILLATORS) {
      throw new Error(`the watchdog comes, but resets only a part: WDSEL is 0x${selected.toString(16)}`);
    }
    this.lasting.reason = reason;
    this.onReset();
  }

  readUint32(offset) {
    if (offset >= SCRATCH0 && offset <= SCRATCH7) {
      return this.lasting.scratch[(offset - SCRATCH0) / 4];
    }
    switch (offset) {
      case CTRL:
        return (this.control | Math.ceil(this.#countsNow)) >>> 0;
      case REASON:
        return this.lasting.reason;
      case TICK:
        return this.tick.value | (this.tick.rate > 0 ? TICK_RUNNING : 0);
    }
    return super.readUint32(offset);
  }

  writeUint32(offset, value) {
    if (offset >= SCRATCH0 && offset <= SCRATCH7) {
      this.lasting.scratch[(offset - SCRATCH0) / 4] = value;
      if (offset === SCRATCH0) {
        this.onMark(value);
      }
      return;
    }
    switch (offset) {
      case CTRL:
        this.#change(() => { this.control = value & (ENABLE | PAUSE); });
        if ((value & TRIGGER) !== 0) {
          this.#fire(BY_TRIGGER);
        }
        break;
      case LOAD:
        this.#change(() => { this.left = value & COUNTS; });
        break;
      case TICK:
        this.#change(() => this.tick.set(value));
        break;
      default:
        super.writeUint32(offset, value);
    }
  }
}
