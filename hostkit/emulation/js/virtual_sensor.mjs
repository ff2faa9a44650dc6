// The virtual MPU-6050, compiled from C to WebAssembly, as a class. Times are in nanoseconds.

import { readFileSync } from 'node:fs';

const PAGE_BYTES = 65536;
const ADDRESS = 0x68;
const PWR_MGMT_1 = 0x6b;
const DEVICE_RESET = 0x80;
const NEVER = 0xffffffffffffffffn;

export class VirtualSensor {
  // wasmFile: the compiled model; table: the bytes of the sample table.
  constructor(wasmFile, table, { settle, loop }) {
    const module = new WebAssembly.Module(readFileSync(wasmFile));
    this.c = new WebAssembly.Instance(module, {}).exports;
    const rowBytes = 7 * 8;
    if (table.length === 0 || table.length % rowBytes !== 0) {
      throw new Error('the sample table is not made of whole rows of seven 64-bit floats');
    }
    this.sensor = this.#place(this.c.hk_virtual_mpu6050_size());
    const rows = this.#place(table.length);
    new Uint8Array(this.c.memory.buffer).set(table, rows);
    this.rowCount = table.length / rowBytes;
    this.c.hk_virtual_mpu6050_init(this.sensor, rows, this.rowCount, settle, loop ? 1 : 0);
  }

  // Take memory behind what the compiler has laid out.
  #place(bytes) {
    const align = 16;
    const free = this.top ?? this.c.__heap_base.value;
    const address = Math.ceil(free / align) * align;
    this.top = address + bytes;
    const missing = this.top - this.c.memory.buffer.byteLength;
    if (missing > 0) {
      this.c.memory.grow(Math.ceil(missing / PAGE_BYTES));
    }
    return address;
  }

  setIdentity(value) {
    this.c.hk_virtual_mpu6050_set_identity(this.sensor, value);
  }

  nackNext(count) {
    this.c.hk_virtual_mpu6050_nack_next(this.sensor, count);
  }

  holdSda(clocks) {
    this.c.hk_virtual_mpu6050_hold_sda(this.sensor, clocks);
  }

  // Plan a fault: kind as hk_fault_kind_t numbers it.
  plan({ kind, row, amount }) {
    if (this.c.hk_virtual_mpu6050_plan(this.sensor, kind, row, amount) === 0) {
      throw new Error(`fault ${kind} cannot be planned: no such kind, or too many`);
    }
  }

  // Its supply has failed and comes back: what it did on the bus ends, and it resets.
  powerCycle() {
    this.stop();
    this.nackNext(0);
    this.holdSda(0);
    this.start(ADDRESS, false);
    this.write(PWR_MGMT_1);
    this.write(DEVICE_RESET);
    this.stop();
  }

  // Take the rows for motion that is sampled and filtered, one every period.
  feelMotion(rowPeriodNs) {
    this.c.hk_virtual_mpu6050_feel_motion(this.sensor, BigInt(rowPeriodNs));
  }

  setAd0(high) {
    this.c.hk_virtual_mpu6050_set_ad0(this.sensor, high ? 1 : 0);
  }

  get struck() {
    return this.c.hk_virtual_mpu6050_struck(this.sensor) >>> 0;
  }

  // How long the sensor holds SCL low from now on.
  get stretchNs() {
    return Number(this.c.hk_virtual_mpu6050_stretch_ns(this.sensor));
  }

  advance(nowNs) {
    this.c.hk_virtual_mpu6050_advance(this.sensor, BigInt(Math.floor(nowNs)));
  }

  start(address, read) {
    return this.c.hk_virtual_mpu6050_start(this.sensor, address, read ? 1 : 0) !== 0;
  }

  write(byte) {
    return this.c.hk_virtual_mpu6050_write(this.sensor, byte) !== 0;
  }

  read() {
    return this.c.hk_virtual_mpu6050_read(this.sensor) & 0xff;
  }

  stop() {
    this.c.hk_virtual_mpu6050_stop(this.sensor);
  }

  clock() {
    this.c.hk_virtual_mpu6050_clock(this.sensor);
  }

  get sdaLow() {
    return this.c.hk_virtual_mpu6050_sda_low(this.sensor) !== 0;
  }

  get intPin() {
    return this.c.hk_virtual_mpu6050_int_pin(this.sensor) !== 0;
  }

  get nextEventNs() {
    const ns = BigInt.asUintN(64, this.c.hk_virtual_mpu6050_next_event_ns(this.sensor));
    return ns === NEVER ? Infinity : Number(ns);
  }

  get exhausted() {
    return this.c.hk_virtual_mpu6050_exhausted(this.sensor) !== 0;
  }

  get rowsPlayed() {
    return this.c.hk_virtual_mpu6050_rows_played(this.sensor) >>> 0;
  }

  get unreadSamples() {
    return this.c.hk_virtual_mpu6050_unread_samples(this.sensor) >>> 0;
  }
}
