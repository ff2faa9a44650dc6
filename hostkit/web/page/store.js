// The samples of the last minutes in typed arrays, oldest overwritten first.

const SPAN_S = 600;
const MOST_SAMPLES = 600_000;
const FEWEST_SAMPLES = 60_000;
const LONGEST_GAP_S = 30;
const SEAM_S = 0.5;
const LATEST_S = 1e9; // beyond it a double no longer tells samples apart

export const BREAK = 1;
export const MISMATCH = 2;
export const KINDS = ["device", "model", "residual"];

/**
 * Columns over a time `x` that only rises: where device time begins anew, a seam is left and the
 * shift between both is remembered.
 */
export class Store {
  constructor(axes, rateHz) {
    const wished = Number.isFinite(rateHz) ? rateHz * SPAN_S : MOST_SAMPLES;
    this.capacity = Math.round(Math.min(MOST_SAMPLES, Math.max(FEWEST_SAMPLES, wished)));
    this.axes = axes;
    this.x = new Float64Array(this.capacity);
    this.flags = new Uint8Array(this.capacity);
    this.columns = axes.flatMap(() => KINDS.map(() => new Float32Array(this.capacity)));
    this.start = 0;
    this.length = 0;
    this.total = 0;
    this.epoch = null;
    this.lastTime = -Infinity;
    this.shifts = [];
    this.joining = false;
  }

  get firstX() { return this.length ? this.x[this.start] : 0; }

  get lastX() { return this.length ? this.x[this.slot(this.length - 1)] : 0; }

  slot(index) { return (this.start + index) % this.capacity; }

  /** The samples that come next may repeat what is here already. */
  rejoin() { this.joining = this.length > 0; }

  append(event) {
    const sources = this.axes.flatMap((axis) => KINDS.map((kind) => event[axis]?.[kind] ?? []));
    const { t, epoch } = event;
    for (let i = 0; i < t.length; i++) {
      const time = t[i];
      if (typeof time !== "number" || !(Math.abs(time) < LATEST_S)) continue;
      if (this.joining && epoch === this.epoch && time <= this.lastTime) continue;
      const follows = this.follows(time, epoch);
      if (!follows) this.seam(time);
      const flags = (follows && !event.begins[i] ? 0 : BREAK) | (event.mismatch[i] ? MISMATCH : 0);
      this.put(time + this.shifts.at(-1).shift, flags, sources, i);
      this.epoch = epoch;
      this.lastTime = time;
      this.joining = false;
    }
  }

  follows(time, epoch) {
    const step = time - this.lastTime;
    return epoch === this.epoch && step > 0 && step < LONGEST_GAP_S;
  }

  seam(time) {
    // Whole seconds, so that the ticks of the axis stay round.
    const shift = this.length ? Math.ceil(this.lastX + SEAM_S - time) : 0;
    this.shifts.push({ x: time + shift, shift });
    while (this.shifts.length > 1 && this.shifts[1].x < this.firstX) this.shifts.shift();
    if (this.shifts.length > 1000) this.shifts.splice(1, 1); // a device that restarts all the time
  }

  put(x, flags, sources, i) {
    const at = this.slot(this.length);
    if (this.length === this.capacity) this.start = (this.start + 1) % this.capacity;
    else this.length++;
    this.x[at] = x;
    this.flags[at] = flags;
    for (let c = 0; c < this.columns.length; c++) this.columns[c][at] = sources[c][i] ?? NaN;
    this.total++;
  }

  /** First index whose x is not below the given one. */
  search(x) {
    let low = 0;
    let high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.x[this.slot(middle)] < x) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Device time of a place on the axis. */
  timeAt(x) {
    for (let i = this.shifts.length - 1; i > 0; i--) {
      if (x >= this.shifts[i].x) return x - this.shifts[i].shift;
    }
    return this.shifts.length ? x - this.shifts[0].shift : x;
  }

  /** The sample nearest to a place: { time, roll: { device, model, residual }, ... }. */
  nearest(x) {
    if (!this.length) return null;
    let index = Math.min(this.search(x), this.length - 1);
    const before = Math.max(0, index - 1);
    if (x - this.x[this.slot(before)] < this.x[this.slot(index)] - x) index = before;
    return this.sample(index);
  }

  latest() { return this.length ? this.sample(this.length - 1) : null; }

  sample(index) {
    const at = this.slot(index);
    const result = { x: this.x[at] };
    this.axes.forEach((axis, a) => {
      result[axis] = {};
      KINDS.forEach((kind, k) => {
        result[axis][kind] = this.columns[a * KINDS.length + k][at];
      });
    });
    return result;
  }
}
