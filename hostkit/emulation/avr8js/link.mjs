// The USART of an emulated ATmega328P. What it receives comes at its own baud rate, one character
// time a byte, into the two bytes and the shift register that the part has; avr8js keeps one byte.

import avr8js from 'avr8js';

const { AVRUSART, usart0Config } = avr8js;

const RXEN = 0x10;
const RXC = 0x80;
const UDRIE = 0x20;
const DEPTH = 3;

export class Link {
  // onByte: called with every byte that is sent.
  constructor(cpu, clockHz, onByte) {
    this.cpu = cpu;
    this.idleAt = 0;
    this.coming = []; // bytes that are on the line
    this.came = []; // bytes that wait to be read
    this.usart = new AVRUSART(cpu, usart0Config, clockHz);
    this.usart.UDRE.constant = true; // the flag stands until a byte is written
    this.usart.onByteTransmit = (value) => {
      this.idleAt = cpu.cycles + this.usart.cyclesPerChar;
      onByte(value);
    };
    this.#wireData();
    this.#wireControl();
  }

  // True when every byte is out and nobody waits to send more.
  get idle() {
    return (this.cpu.data[usart0Config.UCSRB] & UDRIE) === 0 && this.cpu.cycles >= this.idleAt;
  }

  // A byte comes over the line, behind those that are still coming.
  receive(byte) {
    this.coming.push(byte);
    if (this.coming.length === 1) {
      this.#next();
    }
  }

  #next() {
    this.cpu.addClockEvent(() => {
      this.#arrived(this.coming.shift());
      if (this.coming.length > 0) {
        this.#next();
      }
    }, this.usart.cyclesPerChar);
  }

  // Without the receiver, or behind bytes that nobody has read, a byte is lost.
  #arrived(byte) {
    const listening = (this.cpu.data[usart0Config.UCSRB] & RXEN) !== 0;
    if (listening && this.came.length < DEPTH) {
      this.came.push(byte);
      this.#show();
    }
  }

  #show() {
    this.usart.rxByte = this.came[0];
    this.cpu.setInterruptFlag(this.usart.RXC);
  }

  // Reading the data register takes a byte; the next one moves up.
  #wireData() {
    const { cpu } = this;
    const readData = cpu.readHooks[usart0Config.UDR];
    cpu.readHooks[usart0Config.UDR] = (...rest) => {
      const value = readData(...rest);
      this.came.shift();
      if (this.came.length > 0) {
        this.#show();
      }
      return value;
    };
  }

  // Writing UCSRB leaves what has come alone, unless it switches the receiver off; avr8js takes the
  // flag away whenever the receiver stays on.
  #wireControl() {
    const { cpu } = this;
    const writeControl = cpu.writeHooks[usart0Config.UCSRB];
    cpu.writeHooks[usart0Config.UCSRB] = (value, ...rest) => {
      const done = writeControl(value, ...rest);
      if ((value & RXEN) === 0) {
        this.came = [];
        cpu.clearInterrupt(this.usart.RXC);
      } else if (this.came.length > 0 && (cpu.data[usart0Config.UCSRA] & RXC) === 0) {
        this.#show();
      }
      return done;
    };
  }
}
