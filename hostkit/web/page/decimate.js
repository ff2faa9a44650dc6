// Fewer points than samples for drawing: of every pixel the least and the greatest value.

import { BREAK, MISMATCH } from "./store.js";

const DENSE = 2; // samples per pixel from which on it is worth it

/** Whether an angle goes from one end of its range to the other; no line belongs there. */
function wraps(store, before, at) {
  return store.columns.some((column) => Math.abs(column[at] - column[before]) > 180);
}

/** Rows to draw, in arrays that are used again for every picture. */
export class Rows {
  constructor(columns) {
    this.x = [];
    this.lines = Array.from({ length: columns }, () => []);
    this.mismatches = [];
    this.least = new Float64Array(columns);
    this.most = new Float64Array(columns);
    this.leastFirst = new Uint8Array(columns);
  }

  /** Take what a store has between two places, for so many pixels. */
  fill(store, from, to, pixels) {
    this.x.length = 0;
    this.mismatches.length = 0;
    for (const line of this.lines) line.length = 0;
    // One more on either side, so that lines reach the edge.
    const first = Math.max(0, store.search(from) - 1);
    const end = Math.min(store.length, store.search(to) + 1);
    if (end - first <= pixels * DENSE) this.every(store, first, end);
    else this.buckets(store, first, end, (to - from) / pixels);
    return this;
  }

  every(store, first, end) {
    let before = -1;
    for (let index = first; index < end; index++) {
      const at = store.slot(index);
      const x = store.x[at];
      if (store.flags[at] & BREAK || (before >= 0 && wraps(store, before, at))) this.gap(x);
      if (store.flags[at] & MISMATCH) this.mismatches.push(x);
      before = at;
      this.x.push(x);
      for (let c = 0; c < this.lines.length; c++) {
        const value = store.columns[c][at];
        this.lines[c].push(value === value ? value : null);
      }
    }
  }

  buckets(store, first, end, width) {
    let index = first;
    while (index < end) {
      // Bounds at whole multiples of the width: the picture does not shimmer while it scrolls.
      const bound = (Math.floor(store.x[store.slot(index)] / width) + 1) * width;
      const begin = index;
      let flags = 0;
      this.least.fill(Infinity);
      this.most.fill(-Infinity);
      for (; index < end; index++) {
        const at = store.slot(index);
        if (store.x[at] >= bound && index > begin) break;
        flags |= store.flags[at];
        this.widen(store, at);
      }
      this.bucket(store.x[store.slot(begin)], store.x[store.slot(index - 1)], flags);
    }
  }

  widen(store, at) {
    for (let c = 0; c < this.lines.length; c++) {
      const value = store.columns[c][at];
      if (value < this.least[c]) {
        this.least[c] = value;
        this.leastFirst[c] = 0;
      }
      if (value > this.most[c]) {
        this.most[c] = value;
        this.leastFirst[c] = 1;
      }
    }
  }

  bucket(from, to, flags) {
    if (flags & BREAK) this.gap(from);
    if (flags & MISMATCH) this.mismatches.push(from);
    this.x.push(from);
    const two = to > from;
    if (two) this.x.push(to);
    for (let c = 0; c < this.lines.length; c++) {
      const [a, b] = this.ends(c);
      this.lines[c].push(a);
      if (two) this.lines[c].push(b);
    }
  }

  ends(c) {
    if (this.least[c] === Infinity) return [null, null];
    // The one that was reached last stands last.
    return this.leastFirst[c] ? [this.least[c], this.most[c]] : [this.most[c], this.least[c]];
  }

  gap(x) {
    const before = this.x.length ? (this.x[this.x.length - 1] + x) / 2 : x;
    this.x.push(before);
    for (const line of this.lines) line.push(null);
  }
}
