// The pins and the two-wire bus of an emulated ATmega328P with the virtual MPU-6050 on them: SDA PC4,
// SCL PC5, INT PD2.

import avr8js from 'avr8js';

const { AVRIOPort, AVRTWI, PinState, portCConfig, portDConfig, twiConfig } = avr8js;

const SDA_PIN = 4;
const SCL_PIN = 5;
const INT_PIN = 2;
const TWEN = 0x04;
const TWI_IDLE = 0xf8;

export class Bus {
  // machine: has cpu, sensor, nowNs, clockHz and sensorMoved().
  constructor(machine) {
    this.machine = machine;
    this.session = 0; // a transfer that the firmware has given up comes to nothing
    this.#wirePins();
    this.twi = new AVRTWI(machine.cpu, twiConfig, machine.clockHz);
    this.twi.eventHandler = this.#handler();
    this.#wireControl();
  }

  // Drive the pins as the sensor does.
  show() {
    const { sensor } = this.machine;
    this.portD.setPin(INT_PIN, sensor.intPin);
    this.portC.setPin(SDA_PIN, !sensor.sdaLow);
  }

  // A firmware that drives SCL by hand clocks the sensor.
  #wirePins() {
    const { cpu, sensor } = this.machine;
    this.portC = new AVRIOPort(cpu, portCConfig);
    this.portD = new AVRIOPort(cpu, portDConfig);
    this.portC.setPin(SCL_PIN, true);
    this.portC.setPin(SDA_PIN, true);
    let wasLow = false;
    this.portC.addListener(() => {
      const owned = (cpu.data[twiConfig.TWCR] & TWEN) !== 0; // the TWI drives the pin
      const low = !owned && this.portC.pinState(SCL_PIN) === PinState.Low;
      if (wasLow && !low && !owned) {
        sensor.clock();
        this.portC.setPin(SDA_PIN, !sensor.sdaLow);
      }
      wasLow = low;
    });
  }

  // Act on the sensor when so many bits have passed.
  #after(bits, action) {
    const { machine } = this;
    const { cpu, sensor, clockHz } = machine;
    const begun = this.session;
    sensor.advance(machine.nowNs);
    const heldNs = bits > 1 ? sensor.stretchNs : 0; // a byte; START and STOP have one bit
    const cycles = Math.round((bits * clockHz) / this.twi.sclFrequency + (heldNs * clockHz) / 1e9);
    cpu.addClockEvent(() => {
      if (begun !== this.session) {
        return;
      }
      sensor.advance(machine.nowNs);
      action();
      machine.sensorMoved();
    }, cycles);
  }

  #handler() {
    const { twi } = this;
    const { sensor } = this.machine;
    return {
      start: () => {
        if (!sensor.sdaLow) { // with SDA low the bus looks busy and START never comes
          this.#after(1, () => twi.completeStart());
        }
      },
      stop: () => this.#after(1, () => {
        sensor.stop();
        twi.completeStop();
      }),
      connectToSlave: (address, write) =>
        this.#after(9, () => twi.completeConnect(sensor.start(address, !write))),
      writeByte: (value) => this.#after(9, () => twi.completeWrite(sensor.write(value))),
      readByte: () => this.#after(9, () => twi.completeRead(sensor.read())),
    };
  }

  // Switching the peripheral off ends whatever it waits for; avr8js leaves that out.
  #wireControl() {
    const { cpu, sensor } = this.machine;
    const writeControl = cpu.writeHooks[twiConfig.TWCR];
    cpu.writeHooks[twiConfig.TWCR] = (value, ...rest) => {
      if ((value & TWEN) === 0) {
        this.session += 1;
        this.twi.busy = false;
        sensor.stop();
        cpu.data[twiConfig.TWSR] = (cpu.data[twiConfig.TWSR] & 0x07) | TWI_IDLE;
      }
      return writeControl(value, ...rest);
    };
  }
}
