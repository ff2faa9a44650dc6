// The virtual MPU-6050 on I2C0 of the RP2040: SDA on GP4, SCL on GP5, INT on GP6. The controller is
// that of rp2040js; the time that it takes follows from its registers.

import { GPIOPinState, I2CMode, RPI2C } from 'rp2040js';

const SDA_PIN = 4;
const SCL_PIN = 5;
const INT_PIN = 6;
const FUNCTION_I2C = 3;
const IRQ = 23;

const CON = 0x00;
const TAR = 0x04;
const DATA_CMD = 0x10;
const SDA_HOLD = 0x7c;
const FS_SPKLEN = 0xa0;
const ENABLE = 0x01;
const TX_ABRT = 1 << 6;

// What rp2040js leaves out of the controller: commands after a NACK are lost until it is
// acknowledged, target and mode may change only while it is off, the spike filter may be odd.
function complete(controller) {
  const write = controller.writeUint32.bind(controller);
  controller.writeUint32 = (offset, value) => {
    const on = (controller.enable & ENABLE) !== 0;
    if (on && [CON, TAR, SDA_HOLD, FS_SPKLEN].includes(offset)) {
      throw new Error(`register 0x${offset.toString(16)} of I2C0 was set while it was on`);
    }
    if (offset === FS_SPKLEN) {
      controller.spikelen = value & 0xff;
    } else if (offset === DATA_CMD && (controller.intRaw & TX_ABRT) !== 0) {
      return;
    } else if (offset !== SDA_HOLD) { // has no effect on what the sensor sees
      write(offset, value);
    }
  };
}

export class SensorBus {
  constructor(chip, sensor) {
    this.chip = chip;
    this.sensor = sensor;
    this.action = null;
    this.alarm = chip.clock.createAlarm(() => this.#act());
    this.eventAt = Infinity;
    this.event = chip.clock.createAlarm(() => this.moved(this.eventAt));
    this.#wireClock();
    chip.gpio[SCL_PIN].setInputValue(true);
    chip.gpio[SDA_PIN].setInputValue(true);
    this.moved();
  }

  // Return a controller as it is after a reset; the one before it is gone with all it waits for.
  renew() {
    const controller = new RPI2C(this.chip, 'I2C0', IRQ);
    this.alarm.cancel();
    this.action = null;
    this.chip.setInterrupt(IRQ, false);
    this.chip.i2c[0] = controller;
    complete(controller);
    this.#wire(controller);
    return controller;
  }

  #connected() {
    return [SDA_PIN, SCL_PIN].every((pin) => {
      const { functionSelect, inputEnable } = this.chip.gpio[pin];
      return functionSelect === FUNCTION_I2C && inputEnable;
    });
  }

  #wire(controller) {
    const { sensor } = this;
    controller.onStart = () => {
      if (!sensor.sdaLow && this.#connected()) { // with SDA low the bus looks busy
        this.#after(1, controller, () => controller.completeStart());
      }
    };
    controller.onStop = () => this.#after(1, controller, () => {
      sensor.stop();
      controller.completeStop();
    });
    controller.onConnect = (address, mode) => this.#after(9, controller, () =>
      controller.completeConnect(sensor.start(address, mode === I2CMode.Read)));
    controller.onWriteByte = (value) => this.#after(9, controller, () =>
      controller.completeWrite(sensor.write(value)));
    controller.onReadByte = () => this.#after(9, controller, () =>
      controller.completeRead(sensor.read()));
  }

  // SCL is high for HCNT + SPKLEN + 7 and low for LCNT + 1 periods of clk_sys.
  #after(bits, controller, action) {
    const { sclHighPeriod, sclLowPeriod, spikelen } = controller;
    const cycles = sclHighPeriod + spikelen + 7 + sclLowPeriod + 1;
    this.sensor.advance(this.chip.clock.nanos);
    const heldNs = bits > 1 ? this.sensor.stretchNs : 0; // a byte; START and STOP have one bit
    this.action = action;
    this.alarm.schedule((bits * cycles * 1e9) / this.chip.clkSys + heldNs);
  }

  #act() {
    const { action } = this;
    this.action = null;
    this.sensor.advance(this.chip.clock.nanos);
    action();
    this.moved();
  }

  // Clocks that the firmware makes itself, to free the bus.
  #wireClock() {
    const pin = this.chip.gpio[SCL_PIN];
    let wasLow = false;
    pin.addListener(() => {
      const low = pin.value === GPIOPinState.Low;
      if (wasLow && !low) {
        this.sensor.clock();
        this.moved();
      }
      wasLow = low;
    });
  }

  #setPin(number, level) {
    const pin = this.chip.gpio[number];
    if (pin.rawInputValue !== level) {
      pin.setInputValue(level);
    }
  }

  // Bring the sensor up to date, drive its pins, and come back when it changes by itself.
  moved(atNs = 0) {
    const { chip, sensor } = this;
    const nowNs = Math.max(chip.clock.nanos, atNs);
    sensor.advance(nowNs);
    this.#setPin(INT_PIN, sensor.intPin);
    this.#setPin(SDA_PIN, !sensor.sdaLow);
    this.eventAt = sensor.nextEventNs;
    if (this.eventAt === Infinity) {
      this.event.cancel();
    } else {
      this.event.schedule(Math.max(this.eventAt - chip.clock.nanos, 0));
    }
  }
}
