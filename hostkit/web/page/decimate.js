// Fewer points than samples for drawing: of every pixel the least and the greatest value.

import { BREAK, MISMATCH } from "./store.js";

const DENSE = 2; // samples per pixel from which on it is worth it

/** Whether an angle goes from one end of its range to the other; no line belongs there. */
function wraps(before, after) {
  return before * after < 0 && Math.abs(after - before) > 180;
}

/** What one line shows of one pixel. */
class Extremes {
  constructor() {
    this.drawn = NaN;
    this.clear();
  }

  clear() {
    this.least = Infinity;
    this.most = -Infinity;
    this.leastAbove = Infinity;
    this.mostBelow = -Infinity;
    this.last = NaN;
    this.wrapped = false;
  }

  take(value) {
    if (value !== value) return;
    if (this.last !== this.last) this.firstAbove = value > 0;
    else if (wraps(this.last, value)) this.wrapped = true;
    if (value < this.least) {
      this.least = value;
      this.rising = false;
    }
    if (value > this.most) {
      this.most = value;
      this.rising = true;
    }
    if (value > 0) this.leastAbove = Math.min(this.leastAbove, value);
    else this.mostBelow = Math.max(this.mostBelow, value);
    this.last = value;
  }

  /** The ends of the strokes to draw: one, or two if the angle wrapped, on either side of 0. */
  ends() {
    const { least, most, leastAbove, mostBelow } = this;
    if (least === Infinity) return [null, null];
    if (this.wrapped) {
      return this.firstAbove ? [leastAbove, most, least, mostBelow] : [mostBelow, least, most, leastAbove];
    }
    // The one that was reached last stands last.
    return this.rising ? [least, most] : [most, least];
  }
}

/** Rows to draw, in arrays that are used again for every picture. null lifts the pen, undefined not. */
export class Rows {
  constructor(columns) {
    this.x = [];
    this.lines = Array.from({ length: columns }, () => []);
    this.mismatches = [];
    this.extremes = Array.from({ length: columns }, () => new Extremes());
  }

  /** Take what a store has between two places, for so many pixels. */
  fill(store, from, to, pixels) {
    this.x.length = 0;
    this.mismatches.length = 0;
    for (const line of this.lines) line.length = 0;
    for (const one of this.extremes) one.drawn = NaN;
    // One more on either side, so that lines reach the edge.
    const first = Math.max(0, store.search(from) - 1);
    const end = Math.min(store.length, store.search(to) + 1);
    if (end - first <= pixels * DENSE) this.every(store, first, end);
    else this.buckets(store, first, end, (to - from) / pixels);
    return this;
  }

  every(store, first, end) {
    for (let index = first; index < end; index++) {
      const at = store.slot(index);
      const x = store.x[at];
      const ends = store.columns.map(({ [at]: value }) => (value === value ? [value] : [null]));
      this.begin(x, store.flags[at], ends);
      this.row(x, ends.map(([value]) => value));
    }
  }

  buckets(store, first, end, width) {
    let index = first;
    while (index < end) {
      // Bounds at whole multiples of the width: the picture does not shimmer while it scrolls.
      const bound = (Math.floor(store.x[store.slot(index)] / width) + 1) * width;
      const begin = index;
      let flags = 0;
      for (const one of this.extremes) one.clear();
      for (; index < end; index++) {
        const at = store.slot(index);
        if (store.x[at] >= bound && index > begin) break;
        flags |= store.flags[at];
        this.extremes.forEach((one, c) => one.take(store.columns[c][at]));
      }
      this.bucket(store.x[store.slot(begin)], store.x[store.slot(index - 1)], flags);
    }
  }

  bucket(from, to, flags) {
    const ends = this.extremes.map((one) => one.ends());
    this.begin(from, flags, ends);
    this.row(from, ends.map(([first]) => first));
    if (to > from) this.row(to, ends.map(([, second]) => second));
    if (!ends.some(({ length }) => length > 2)) return;
    this.row(to, ends.map(({ length }) => (length > 2 ? null : undefined)));
    for (const part of [2, 3]) this.row(to, ends.map((values) => values[part]));
  }

  /** Lift the pen where the samples or an angle do not go on; note what is to be marked. */
  begin(x, flags, ends) {
    const between = this.x.length ? (this.x[this.x.length - 1] + x) / 2 : x;
    const lifted = ends.map(([first], c) => wraps(this.extremes[c].drawn, first));
    if (flags & BREAK) this.row(between, ends.map(() => null));
    else if (lifted.includes(true)) this.row(between, lifted.map((up) => (up ? null : undefined)));
    if (flags & MISMATCH) this.mismatches.push(x);
  }

  row(x, values) {
    this.x.push(x);
    values.forEach((value, c) => {
      this.lines[c].push(value);
      if (typeof value === "number") this.extremes[c].drawn = value;
    });
  }
}
