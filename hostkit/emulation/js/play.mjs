// Plays a table of samples to the firmware on an emulated board; what the link sends goes to
// standard output. Every board takes these options:
//
// --image       the file that would be flashed
// --sensor      the virtual sensor, a WebAssembly module
// --table       rows of seven little-endian 64-bit floats: rate (rad/s), force (m/s^2), degC
// --settle N    samples that the driver drops before the first row
// --realtime    keep pace with the wall clock and loop the table until SIGTERM
// --statistics  write one line of JSON to this file at the end
// --progress    say on standard error how many rows have been played
// --who-am-i N, --nack N, --hold-sda CLOCKS: faults of the sensor; --fault-row N: from which row on
// --fault KIND:ROW:AMOUNT: plan a fault of the sensor, as often as wanted; KIND as hk_fault_kind_t
//                          numbers it
// --store FILE       what the non-volatile store holds; written back at the end
// --received FILE    what the link receives and when: float64 s, uint32 length, bytes, and so on;
//                    with --realtime it receives what comes on standard input instead
// --power-cut BYTES  the supply fails once so many bytes have been written to the store
//
// A machine has: sensor, segments, stackBytes, busyShare, timeS, finished, resets, runUntil(timeS),
// receive(byte), to be called with every byte that the link is to receive, and sensorMoved(), to be
// called when something was done to the sensor.

import { readFileSync, writeFileSync, writeSync } from 'node:fs';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';

import { NonVolatile } from './nonvolatile.mjs';
import { VirtualSensor } from './virtual_sensor.mjs';

const STALL_S = 5;
const CLOCK_STEP_S = 1e-7; // no machine stops closer to a time than its clock allows
const SLICE_S = 0.1;
const UNARMED_SLICE_S = 0.001;
const FAULT_SLICE_S = 0.01;
const REALTIME_SLICE_S = 0.005;
const LAG_LIMIT_S = 1;
const PROGRESS_MS = 250;
const STANDARD_OUTPUT = 1;

function options() {
  const text = { type: 'string' };
  const { values } = parseArgs({
    options: {
      image: text, sensor: text, table: text, statistics: text,
      settle: { ...text, default: '0' },
      realtime: { type: 'boolean', default: false },
      progress: { type: 'boolean', default: false },
      'who-am-i': text,
      nack: { ...text, default: '0' },
      'hold-sda': { ...text, default: '0' },
      'fault-row': { ...text, default: '0' },
      fault: { ...text, multiple: true, default: [] },
      store: text,
      received: text,
      'power-cut': text,
    },
  });
  for (const name of ['image', 'sensor', 'table']) {
    if (values[name] === undefined) {
      throw new Error(`--${name} is missing`);
    }
  }
  return values;
}

// Collects the bytes of the link and writes them without waiting for the event loop.
class Output {
  constructor() {
    this.bytes = [];
    this.closed = false;
  }

  put(byte) {
    this.bytes.push(byte);
  }

  flush() {
    let rest = Buffer.from(this.bytes);
    this.bytes = [];
    while (rest.length > 0 && !this.closed) {
      try {
        rest = rest.subarray(writeSync(STANDARD_OUTPUT, rest));
      } catch (error) {
        if (error.code !== 'EAGAIN') {
          this.closed = true; // nobody reads any more
        }
      }
    }
  }
}

// Ends a run in which the firmware takes no rows any more.
class Watch {
  constructor(machine) {
    this.machine = machine;
    this.row = -1;
    this.stalled = false;
  }

  check() {
    const { sensor, timeS } = this.machine;
    if (sensor.rowsPlayed !== this.row) {
      this.row = sensor.rowsPlayed;
      this.since = timeS;
    }
    this.stalled = timeS - this.since > STALL_S;
    return this.stalled;
  }
}

// Hands the machine what its link receives at the time that was planned.
class Script {
  constructor(file) {
    this.pieces = [];
    for (let at = 0; at < file.length;) {
      const timeS = file.readDoubleLE(at);
      const end = at + 12 + file.readUInt32LE(at + 8);
      this.pieces.push({ timeS, bytes: file.subarray(at + 12, end) });
      at = end;
    }
  }

  get nextS() {
    return this.pieces.length > 0 ? this.pieces[0].timeS : Infinity;
  }

  play(machine) {
    while (machine.timeS + CLOCK_STEP_S >= this.nextS) {
      this.pieces.shift().bytes.forEach((byte) => machine.receive(byte));
    }
  }
}

function armFaults(machine, values) {
  const { sensor } = machine;
  if (values.armed || sensor.rowsPlayed < Number(values['fault-row'])) {
    return;
  }
  values.armed = true;
  sensor.nackNext(Number(values.nack));
  sensor.holdSda(Number(values['hold-sda']));
  machine.sensorMoved();
}

function runToEnd(machine, output, values) {
  const script = new Script(values.received === undefined ? Buffer.alloc(0) : readFileSync(values.received));
  const watch = new Watch(machine);
  const armedSliceS = values.fault.length > 0 ? FAULT_SLICE_S : SLICE_S;
  const sliceS = values.armed ? armedSliceS : UNARMED_SLICE_S;
  let told = Date.now();
  while (!machine.finished && !watch.check() && !output.closed) {
    script.play(machine);
    machine.runUntil(Math.min(machine.timeS + sliceS, script.nextS));
    armFaults(machine, values);
    output.flush();
    if (values.progress && Date.now() - told >= PROGRESS_MS) {
      told = Date.now();
      process.stderr.write(`progress ${machine.sensor.rowsPlayed}\n`);
    }
  }
  return watch.stalled;
}

async function runInRealTime(machine, output, values) {
  let stop = false;
  process.on('SIGTERM', () => { stop = true; });
  process.on('SIGINT', () => { stop = true; });
  process.stdin.on('data', (data) => data.forEach((byte) => machine.receive(byte)));
  let origin = performance.now() / 1000 - machine.timeS;
  while (!stop && !output.closed) {
    const due = performance.now() / 1000 - origin;
    if (due - machine.timeS > LAG_LIMIT_S) {
      origin += due - machine.timeS; // the host was busy: go on from here
    }
    machine.runUntil(performance.now() / 1000 - origin);
    armFaults(machine, values);
    output.flush();
    await sleep(REALTIME_SLICE_S * 1000);
  }
  process.stdin.destroy();
}

function statistics(machine, stalled) {
  const { count, sum, min, max } = machine.segments;
  return {
    rows_played: machine.sensor.rowsPlayed,
    unread_samples: machine.sensor.unreadSamples,
    struck: machine.sensor.struck,
    stalled: stalled ? 1 : 0,
    resets: machine.resets,
    time_s: machine.timeS,
    segments: count,
    cycles_min: count ? min : null,
    cycles_mean: count ? sum / count : null,
    cycles_max: count ? max : null,
    stack_bytes: machine.stackBytes,
    busy_share: machine.busyShare,
  };
}

async function run(makeMachine) {
  const values = options();
  const sensor = new VirtualSensor(values.sensor, readFileSync(values.table), {
    settle: Number(values.settle),
    loop: values.realtime,
  });
  if (values['who-am-i'] !== undefined) {
    sensor.setIdentity(Number(values['who-am-i']));
  }
  for (const fault of values.fault) {
    const [kind, row, amount] = fault.split(':').map(Number);
    sensor.plan({ kind, row, amount });
  }
  const output = new Output();
  const nonvolatile = new NonVolatile(
    values.store === undefined ? Buffer.alloc(0) : readFileSync(values.store),
    Number(values['power-cut'] ?? Infinity),
  );
  const machine = makeMachine(
    readFileSync(values.image), sensor, (byte) => output.put(byte), nonvolatile,
  );
  values.armed = false;
  armFaults(machine, values);
  let stalled = false;
  if (values.realtime) {
    await runInRealTime(machine, output, values);
  } else {
    stalled = runToEnd(machine, output, values);
  }
  if (values.store !== undefined) {
    writeFileSync(values.store, nonvolatile.bytes);
  }
  if (values.statistics !== undefined) {
    writeFileSync(values.statistics, `${JSON.stringify(statistics(machine, stalled))}\n`);
  }
}

// makeMachine: takes the bytes of the image, the sensor, what is called with every byte that the link
// sends, and the content of the non-volatile store.
export async function play(makeMachine) {
  try {
    await run(makeMachine);
  } catch (error) {
    process.stderr.write(`board: ${error.message}\n`);
    process.exitCode = 1;
  }
}
