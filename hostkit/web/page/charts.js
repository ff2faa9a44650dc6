// Both charts: angle of device and model, and the residual below, with one axis of time.

import { Rows } from "./decimate.js";
import { readColours } from "./colours.js";
import { figure } from "./format.js";
import { KINDS } from "./store.js";

const FONT = "11px system-ui, sans-serif";
const LEAST_SPAN_DEG = { angle: 2, residual: 0.002 };

/** Keep a range while the data still fill it, so that a chart does not jitter. */
function steadyRange(least) {
  let kept = null;
  return (plot, low, high) => {
    if (low === null || high === null) return kept ?? [-least, least];
    const span = Math.max(high - low, least);
    const fits = kept && low >= kept[0] && high <= kept[1] && span * 2.5 > kept[1] - kept[0];
    if (!fits) {
      const middle = (low + high) / 2;
      kept = [middle - span * 0.6, middle + span * 0.6];
    }
    return kept;
  };
}

/** A line that is not drawn over nulls; uPlot would draw it and cut out less than its width. */
function strokes(plot, series, first, last) {
  const stroke = new Path2D();
  let down = false;
  for (let i = first; i <= last; i++) {
    const value = plot.data[series][i];
    if (typeof value === "number") {
      const x = plot.valToPos(plot.data[0][i], "x", true);
      const y = plot.valToPos(value, "y", true);
      if (!down) stroke.moveTo(x - 0.5, y); // so that a sample on its own is seen
      stroke.lineTo(x, y);
    }
    down = value !== null && (down || value !== undefined);
  }
  return { stroke };
}

export class Charts {
  /** `cursor` gets the sample under the pointer, or null; `drawn` is called after a picture. */
  constructor(uPlot, { store, view, boxes, cursor, drawn }) {
    Object.assign(this, { uPlot, store, view, cursor, drawn });
    this.rows = new Rows(store.columns.length);
    this.colours = readColours();
    this.limitDeg = null;
    this.boxes = boxes;
    this.angle = this.make(boxes.angle, "angle", ["device", "model"]);
    this.residual = this.make(boxes.residual, "residual", ["residual"]);
    const observer = new ResizeObserver(() => this.resize());
    Object.values(boxes).forEach((box) => observer.observe(box));
  }

  make(box, kind, kinds) {
    const series = this.store.axes.flatMap((axis) => kinds.map((k) => this.series(axis, k)));
    const options = {
      ...this.size(box),
      padding: [8, 12, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { show: false }, sync: { key: "time" } },
      scales: {
        x: { time: false, range: () => [this.view.from, this.view.to] },
        y: { range: steadyRange(LEAST_SPAN_DEG[kind]) },
      },
      axes: [this.timeAxis(kind === "residual"), this.angleAxis()],
      series: [{}, ...series],
      hooks: this.hooks(kind),
    };
    return new this.uPlot(options, [[], ...series.map(() => [])], box);
  }

  hooks(kind) {
    if (kind === "angle") return { setCursor: [(plot) => this.pointed(plot)] };
    return {
      drawClear: [(plot) => this.band(plot)],
      draw: [(plot) => this.marks(plot), () => this.drawn()],
      setCursor: [(plot) => this.pointed(plot)],
    };
  }

  series(axis, kind) {
    const model = kind === "model";
    return {
      stroke: () => (model ? this.colours.ink : this.colours[axis]),
      width: model ? 1.25 : kind === "device" ? 3 : 1.25,
      dash: model ? [6, 6] : undefined,
      points: { show: false },
      paths: strokes,
    };
  }

  timeAxis(labelled) {
    return {
      stroke: () => this.colours.soft,
      grid: { stroke: () => this.colours.line, width: 1 },
      ticks: { show: false },
      font: FONT,
      size: labelled ? 26 : 22,
      values: (plot, ticks) => ticks.map((x) => `${+this.store.timeAt(x).toFixed(2)} s`),
    };
  }

  angleAxis() {
    return {
      stroke: () => this.colours.soft,
      grid: { stroke: () => this.colours.line, width: 1 },
      ticks: { show: false },
      font: FONT,
      size: 64,
      values: (plot, ticks) => ticks.map((value) => `${+value.toPrecision(6)}°`),
    };
  }

  size(box) {
    return { width: Math.max(120, box.clientWidth), height: Math.max(60, box.clientHeight) };
  }

  resize() {
    this.angle.setSize(this.size(this.boxes.angle));
    this.residual.setSize(this.size(this.boxes.residual));
  }

  recolour() {
    this.colours = readColours();
    this.draw();
  }

  draw() {
    const { from, to } = this.view;
    const { x, lines } = this.rows.fill(this.store, from, to, this.angle.bbox.width || 600);
    const of = (wanted) => lines.filter((_, c) => wanted.includes(KINDS[c % KINDS.length]));
    this.angle.setData([x, ...of(["device", "model"])]);
    this.residual.setData([x, ...of(["residual"])]);
  }

  pointed(plot) {
    const { left } = plot.cursor;
    this.cursor(left >= 0 ? this.store.nearest(plot.posToVal(left, "x")) : null);
  }

  /** Shade what the thresholds allow. */
  band(plot) {
    if (this.limitDeg === null) return;
    const { left, top, width, height } = plot.bbox;
    const place = (value) => plot.valToPos(value, "y", true);
    const upper = Math.max(top, place(this.limitDeg));
    const lower = Math.min(top + height, place(-this.limitDeg));
    plot.ctx.save();
    plot.ctx.fillStyle = this.colours.band;
    plot.ctx.fillRect(left, upper, width, Math.max(0, lower - upper));
    plot.ctx.restore();
  }

  /** Mark samples that the integer model does not confirm. */
  marks(plot) {
    const { left, top, width, height } = plot.bbox;
    const { ctx } = plot;
    ctx.save();
    ctx.fillStyle = this.colours.bad;
    for (const x of this.rows.mismatches) {
      const at = plot.valToPos(x, "x", true);
      if (at >= left && at <= left + width) ctx.fillRect(at - 1, top + height - 10, 3, 10);
    }
    ctx.restore();
  }

  /** Take the limits of the residual; gives what the band stands for. */
  allow({ max_abs_deg: most = null, max_rms_deg: rms = null }) {
    this.limitDeg = most ?? rms;
    if (this.limitDeg === null) return "";
    return `${most === null ? "RMS allowed" : "allowed"} ±${figure(this.limitDeg)}°`;
  }
}
