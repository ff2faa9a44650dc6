// A PL011 with its FIFOs and its timing. It interrupts when the FIFO of the transmitter has run down
// to a level, not while it is below; when that of the receiver has come up to one; and when a byte
// has waited there for 32 bits without another. The UART of rp2040js sends in no time and always
// asks for more.

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
const RX_FULL = 1 << 6;
const TX_EMPTY = 1 << 7;
const RX_INTERRUPT = 1 << 4;
const TX_INTERRUPT = 1 << 5;
const SILENCE_INTERRUPT = 1 << 6;
const FIFOS = 1 << 4;
const TX_ON = (1 << 8) | (1 << 0);
const RX_ON = (1 << 9) | (1 << 0);
const OVERRUN = 1 << 11;
const LEVELS = [4, 8, 16, 24, 28];
const FIFO_BYTES = 32;
const SILENCE_BITS = 32;
const NOMINAL_HZ = 115200; // of a wire into a UART that is not set up
const IRQ = 20;

const RX_PIN = 1;
const FUNCTION_UART = 2;

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
    this.received = [];
    this.overrun = 0;
    this.silence = chip.clock.createAlarm(() => this.#raise(SILENCE_INTERRUPT));
  }

  // True when every byte is out and nobody waits to send more.
  get idle() {
    return this.leaving === null && (this.registers.get(IMSC) & TX_INTERRUPT) === 0;
  }

  // End whatever goes on, for a reset.
  drop() {
    this.alarm.cancel();
    this.silence.cancel();
    this.rp2040.setInterrupt(IRQ, false);
  }

  // How long a byte takes on the wire.
  get byteNs() {
    const bits = 5 + ((this.registers.get(LCR_H) >> 5) & 0x3) + 2;
    const hz = this.#baud;
    return hz > 0 && hz < Infinity ? (bits * 1e9) / hz : (10 * 1e9) / NOMINAL_HZ;
  }

  get #baud() {
    const divisor = this.registers.get(IBRD) + this.registers.get(FBRD) / 64;
    return this.rp2040.clocks.periFreq / (16 * divisor);
  }

  get #depth() {
    return (this.registers.get(LCR_H) & FIFOS) !== 0 ? FIFO_BYTES : 1;
  }

  get #room() {
    return this.#depth - this.queue.length;
  }

  get #level() {
    return this.#depth > 1 ? LEVELS[this.registers.get(IFLS) & 0x7] : 0;
  }

  get #receiveLevel() {
    return this.#depth > 1 ? LEVELS[(this.registers.get(IFLS) >> 3) & 0x7] : 1;
  }

  #interrupt() {
    this.rp2040.setInterrupt(IRQ, (this.raw & this.registers.get(IMSC)) !== 0);
  }

  // Begin with the next byte if there is one.
  #send() {
    if (this.leaving !== null || this.queue.length === 0 ||
        (this.registers.get(CR) & TX_ON) !== TX_ON) {
      return;
    }
    if (!(this.#baud > 0 && this.#baud < Infinity)) {
      throw new Error('the firmware sends without clk_peri or without a baud rate');
    }
    this.leaving = this.queue.shift();
    if (this.queue.length === this.#level) {
      this.raw |= TX_INTERRUPT;
    }
    this.alarm.schedule(this.byteNs);
    this.#interrupt();
  }

  #left() {
    const byte = this.leaving;
    this.leaving = null;
    this.onByte(byte);
    this.#send();
  }

  #put(byte) {
    if (this.#room <= 0) {
      throw new Error('the firmware writes to a transmitter that is full');
    }
    this.queue.push(byte & 0xff);
    if (this.queue.length > this.#level) {
      this.raw &= ~TX_INTERRUPT;
    }
    this.#send();
  }

  #raise(interrupt) {
    this.raw |= interrupt;
    this.#interrupt();
  }

  get #listening() {
    const { functionSelect, inputEnable } = this.rp2040.gpio[RX_PIN];
    const on = (this.registers.get(CR) & RX_ON) === RX_ON;
    return on && functionSelect === FUNCTION_UART && inputEnable;
  }

  // Take a byte from the wire. It is lost where nobody listens, and where the FIFO is full.
  take(byte) {
    if (!this.#listening) {
      return;
    }
    if (this.received.length >= this.#depth) {
      this.overrun = OVERRUN;
      return;
    }
    this.received.push(byte | this.overrun);
    this.overrun = 0;
    if (this.received.length === this.#receiveLevel) {
      this.#raise(RX_INTERRUPT);
    }
    this.silence.schedule((this.byteNs * SILENCE_BITS) / 10);
  }

  #get() {
    const found = this.received.shift();
    if (found === undefined) {
      throw new Error('the firmware reads a receiver that is empty');
    }
    if (this.received.length < this.#receiveLevel) {
      this.raw &= ~RX_INTERRUPT;
    }
    if (this.received.length === 0) {
      this.raw &= ~SILENCE_INTERRUPT;
      this.silence.cancel();
    }
    this.#interrupt();
    return found;
  }

  get #flags() {
    return (this.leaving === null ? 0 : BUSY) |
      (this.received.length > 0 ? 0 : RX_EMPTY) |
      (this.#room > 0 ? 0 : TX_FULL) |
      (this.received.length < this.#depth ? 0 : RX_FULL) |
      (this.queue.length > 0 ? 0 : TX_EMPTY);
  }

  readUint32(offset) {
    switch (offset) {
      case DR:
        return this.#get();
      case FR:
        return this.#flags;
      case RIS:
        return this.raw;
      case MIS:
        return this.raw & this.registers.get(IMSC);
    }
    return this.registers.get(offset) ?? super.readUint32(offset);
  }

  writeUint32(offset, value) {
    if (offset === DR) {
      this.#put(value);
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
