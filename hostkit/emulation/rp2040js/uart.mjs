// The transmitter of a PL011 with its FIFO, its timing, and an interrupt that comes when the FIFO has
// run down to a level, not while it is below. The UART of rp2040js sends in no time and always asks
// for more.

import { BasePeripheral } from 'rp2040js';

const DR = 0x00;
const FR = 0x18;
const IBRD = 0x24;
const FBRD = 0x28;
const LCR_H = 0x2c;
const CR = 0x30;
const IFLS = 0x34;
const IMSC = 0x38;
const RIS = 0x3c;
const MIS = 0x40;
const ICR = 0x44;

const BUSY = 1 << 3;
const RX_EMPTY = 1 << 4;
const TX_FULL = 1 << 5;
const TX_EMPTY = 1 << 7;
const TX_INTERRUPT = 1 << 5;
const FIFOS = 1 << 4;
const ON = (1 << 8) | (1 << 0);
const LEVELS = [4, 8, 16, 24, 28];
const FIFO_BYTES = 32;
const IRQ = 20;

export class Uart extends BasePeripheral {
  // onByte: called with every byte when it has left.
  constructor(chip, onByte) {
    super(chip, 'UART0');
    this.onByte = onByte;
    this.registers = new Map([
      [IBRD, 0], [FBRD, 0], [LCR_H, 0], [CR, 0x300], [IFLS, 0x12], [IMSC, 0],
    ]);
    this.raw = 0;
    this.queue = [];
    this.leaving = null;
    this.alarm = chip.clock.createAlarm(() => this.#left());
  }

  // True when every byte is out and nobody waits to send more.
  get idle() {
    return this.leaving === null && (this.registers.get(IMSC) & TX_INTERRUPT) === 0;
  }

  // End whatever goes on, for a reset.
  drop() {
    this.alarm.cancel();
    this.rp2040.setInterrupt(IRQ, false);
  }

  get #room() {
    return ((this.registers.get(LCR_H) & FIFOS) !== 0 ? FIFO_BYTES : 1) - this.queue.length;
  }

  get #level() {
    const fifos = (this.registers.get(LCR_H) & FIFOS) !== 0;
    return fifos ? LEVELS[this.registers.get(IFLS) & 0x7] : 0;
  }

  get #byteNs() {
    const divisor = this.registers.get(IBRD) + this.registers.get(FBRD) / 64;
    const hz = this.rp2040.clocks.periFreq / (16 * divisor);
    if (!(hz > 0 && hz < Infinity)) {
      throw new Error('the firmware sends without clk_peri or without a baud rate');
    }
    const bits = 5 + ((this.registers.get(LCR_H) >> 5) & 0x3) + 2;
    return (bits * 1e9) / hz;
  }

  #interrupt() {
    this.rp2040.setInterrupt(IRQ, (this.raw & this.registers.get(IMSC)) !== 0);
  }

  // Begin with the next byte if there is one.
  #send() {
    if (this.leaving !== null || this.queue.length === 0 || (this.registers.get(CR) & ON) !== ON) {
      return;
    }
    this.leaving = this.queue.shift();
    if (this.queue.length === this.#level) {
      this.raw |= TX_INTERRUPT;
    }
    this.alarm.schedule(this.#byteNs);
    this.#interrupt();
  }

  #left() {
    const byte = this.leaving;
    this.leaving = null;
    this.onByte(byte);
    this.#send();
  }

  #take(byte) {
    if (this.#room <= 0) {
      throw new Error('the firmware writes to a transmitter that is full');
    }
    this.queue.push(byte & 0xff);
    if (this.queue.length > this.#level) {
      this.raw &= ~TX_INTERRUPT;
    }
    this.#send();
  }

  readUint32(offset) {
    switch (offset) {
      case FR:
        return RX_EMPTY | (this.leaving === null ? 0 : BUSY) | (this.#room > 0 ? 0 : TX_FULL) |
          (this.queue.length > 0 ? 0 : TX_EMPTY);
      case RIS:
        return this.raw;
      case MIS:
        return this.raw & this.registers.get(IMSC);
    }
    return this.registers.get(offset) ?? super.readUint32(offset);
  }

  writeUint32(offset, value) {
    if (offset === DR) {
      this.#take(value);
    } else if (offset === ICR) {
      this.raw &= ~value;
    } else if (this.registers.has(offset)) {
      this.registers.set(offset, value);
      this.#send();
    } else {
      super.writeUint32(offset, value);
    }
    this.#interrupt();
  }
}
