// Which part of the past the charts show: how long, and up to where.

export const SPANS_S = [5, 10, 30, 60];

/** `end` is null while live; otherwise the right edge, on the axis of the store. */
export class View {
  constructor(store, changed) {
    this.store = store;
    this.changed = changed;
    this.spanS = 10;
    this.end = null;
  }

  get live() { return this.end === null; }

  get to() {
    if (this.end === null) return this.store.lastX;
    return Math.max(this.end, this.store.firstX); // what was overwritten is gone
  }

  get from() { return this.to - this.spanS; }

  set(end, spanS = this.spanS) {
    this.end = end;
    this.spanS = spanS;
    this.changed();
  }

  hold(held) { this.set(held ? this.to : null); }

  goLive() { this.set(null); }

  /** Move by a part of the window; behind the newest sample it stands still. */
  scroll(part) { this.moveTo(this.to + part * this.spanS); }

  moveTo(end) {
    const { firstX, lastX } = this.store;
    const first = Math.min(lastX, firstX + this.spanS);
    this.set(Math.min(lastX, Math.max(first, end)));
  }

  zoom(steps) {
    const index = SPANS_S.indexOf(this.spanS) + steps;
    this.set(this.end, SPANS_S[Math.min(SPANS_S.length - 1, Math.max(0, index))]);
  }
}
