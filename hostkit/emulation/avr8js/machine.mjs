// An ATmega328P at 16 MHz on avr8js with the virtual MPU-6050 on its bus, INT on PD2.

import avr8js from 'avr8js';

import { PAINT, Segments, stackBytes } from '../js/measure.mjs';

const {
  AVRIOPort, AVRTWI, AVRTimer, AVRUSART, CPU, PinState,
  avrInstruction, portCConfig, portDConfig, timer1Config, twiConfig, usart0Config,
} = avr8js;

const CLOCK_HZ = 16_000_000;
const NS_PER_CYCLE = 1e9 / CLOCK_HZ;
const PATIENCE_CYCLES = CLOCK_HZ / 100;
const FLASH_BYTES = 32768;
const SRAM_BYTES = 2048;
const SRAM_START = 0x100;

const SLEEP = 0x9588;
const RETI = 0x9518;
const SMCR = 0x53;
const SREG = 0x5f;
const SREG_I = 0x80;
const SLEEP_ENABLE = 0x01;
const GPIOR0 = 0x3e;
const TWEN = 0x04;
const TWI_IDLE = 0xf8;
const UDRIE = 0x20;
const TIMER1_COMPARE_INTERRUPTS = 0x26;

const SDA_PIN = 4;
const SCL_PIN = 5;
const INT_PIN = 2;

export class Machine {
  // image: flash content; onByte: called with every byte that the link sends.
  constructor(image, sensor, onByte, nonvolatile) {
    const program = new Uint16Array(FLASH_BYTES / 2);
    new Uint8Array(program.buffer).set(image);
    this.cpu = new CPU(program, SRAM_BYTES);
    this.cpu.data.fill(PAINT, SRAM_START, SRAM_START + SRAM_BYTES);
    this.sensor = sensor;
    this.nonvolatile = nonvolatile;
    this.resets = 0;
    this.onByte = onByte;
    this.segments = new Segments();
    this.sleeping = false;
    this.sleepCycles = 0;
    this.interruptDepth = 0;
    this.interruptCycles = 0;
    this.linkIdleAt = 0;
    this.playedAt = Infinity;
    this.#wireClock();
    this.#wireLink();
    this.#wirePins();
    this.#wireBus();
    this.#wireMarks();
    this.sensorEventAt = Infinity;
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
    const queued = (this.cpu.data[usart0Config.UCSRB] & UDRIE) !== 0;
    const { cycles } = this.cpu;
    if (!this.sensor.exhausted) {
      this.playedAt = Infinity;
      return false;
    }
    this.playedAt = Math.min(this.playedAt, cycles);
    const done = this.sleeping || cycles - this.playedAt > PATIENCE_CYCLES;
    return done && !queued && cycles >= this.linkIdleAt;
  }

  get busyShare() {
    return 1 - this.sleepCycles / this.cpu.cycles;
  }

  get stackBytes() {
    return stackBytes(this.cpu.data.subarray(SRAM_START, SRAM_START + SRAM_BYTES));
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

  #wireLink() {
    const usart = new AVRUSART(this.cpu, usart0Config, CLOCK_HZ);
    usart.onByteTransmit = (value) => {
      this.linkIdleAt = this.cpu.cycles + usart.cyclesPerChar;
      this.onByte(value);
    };
  }

  #wirePins() {
    this.portC = new AVRIOPort(this.cpu, portCConfig);
    this.portD = new AVRIOPort(this.cpu, portDConfig);
    this.portC.setPin(SCL_PIN, true);
    this.portC.setPin(SDA_PIN, true);
    let wasLow = false;
    this.portC.addListener(() => {
      const owned = (this.cpu.data[twiConfig.TWCR] & TWEN) !== 0; // the TWI drives the pin
      const low = !owned && this.portC.pinState(SCL_PIN) === PinState.Low;
      if (wasLow && !low && !owned) {
        this.sensor.clock();
        this.portC.setPin(SDA_PIN, !this.sensor.sdaLow);
      }
      wasLow = low;
    });
  }

  #wireBus() {
    const { cpu, sensor } = this;
    const twi = new AVRTWI(cpu, twiConfig, CLOCK_HZ);
    let session = 0; // a transfer that the firmware has given up comes to nothing
    const after = (bits, action) => {
      const begun = session;
      sensor.advance(this.nowNs);
      const heldNs = bits > 1 ? sensor.stretchNs : 0; // a byte; START and STOP have one bit
      const cycles = Math.round((bits * CLOCK_HZ) / twi.sclFrequency + heldNs / NS_PER_CYCLE);
      cpu.addClockEvent(() => {
        if (begun !== session) {
          return;
        }
        sensor.advance(this.nowNs);
        action();
        this.sensorMoved();
      }, cycles);
    };
    twi.eventHandler = {
      start: () => {
        if (!sensor.sdaLow) { // with SDA low the bus looks busy and START never comes
          after(1, () => twi.completeStart());
        }
      },
      stop: () => after(1, () => {
        sensor.stop();
        twi.completeStop();
      }),
      connectToSlave: (address, write) =>
        after(9, () => twi.completeConnect(sensor.start(address, !write))),
      writeByte: (value) => after(9, () => twi.completeWrite(sensor.write(value))),
      readByte: () => after(9, () => twi.completeRead(sensor.read())),
    };
    // Switching the peripheral off ends whatever it waits for; avr8js leaves that out.
    const writeControl = cpu.writeHooks[twiConfig.TWCR];
    cpu.writeHooks[twiConfig.TWCR] = (value, ...rest) => {
      if ((value & TWEN) === 0) {
        session += 1;
        twi.busy = false;
        sensor.stop();
        cpu.data[twiConfig.TWSR] = (cpu.data[twiConfig.TWSR] & 0x07) | TWI_IDLE;
      }
      return writeControl(value, ...rest);
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
    this.portD.setPin(INT_PIN, sensor.intPin);
    this.portC.setPin(SDA_PIN, !sensor.sdaLow);
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
    while (this.sleeping && !this.finished) {
      const event = cpu.nextClockEvent;
      if (event === null || !cpu.interruptsEnabled) {
        throw new Error(`the firmware sleeps for ever, at word ${cpu.pc} of flash`);
      }
      this.#skipTo(Math.min(event.cycles, untilCycles));
      if (event.cycles > untilCycles) {
        return;
      }
      this.#tick();
    }
  }

  // Run until a time or until the machine has finished. Where an instruction sets the interrupt flag,
  // be it SEI, RETI or OUT to SREG, the real part runs one more before any interrupt. Sleeping
  // without a race rests on that, and so does the compiler when it moves the stack pointer.
  runUntil(timeS) {
    const untilCycles = Math.floor(timeS * CLOCK_HZ);
    const { cpu } = this;
    const { data, progMem } = cpu;
    while (cpu.cycles < untilCycles && !(this.sleeping && this.finished)) {
      if (this.sleeping) {
        this.#doze(untilCycles);
        continue;
      }
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
        continue;
      }
      if (masked && (data[SREG] & SREG_I) !== 0) {
        continue;
      }
      const event = cpu.nextClockEvent;
      if (cpu.nextInterrupt >= 0 || (event !== null && event.cycles <= cpu.cycles)) {
        this.#tick();
      }
    }
  }
}
