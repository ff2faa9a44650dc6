// The wire into the UART: bytes come one after the other, each in its time.

export class Wire {
  // uart: returns the receiver at the end of the wire; before: the wire of the chip before a reset,
  // of which the bytes that have not come yet are taken over.
  constructor(clock, uart, before) {
    this.uart = uart;
    this.bytes = before?.bytes ?? [];
    this.alarm = clock.createAlarm(() => this.#arrive());
    this.#next();
  }

  get idle() {
    return this.bytes.length === 0;
  }

  send(byte) {
    this.bytes.push(byte);
    if (this.bytes.length === 1) {
      this.#next();
    }
  }

  #next() {
    if (this.bytes.length > 0) {
      this.alarm.schedule(this.uart().byteNs);
    }
  }

  #arrive() {
    this.uart().take(this.bytes.shift());
    this.#next();
  }
}
