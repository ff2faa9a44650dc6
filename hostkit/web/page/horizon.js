// The artificial horizon: an SVG for the eye, words for everybody else.

import { byId, element, text } from "./dom.js";
import { angle, degrees } from "./format.js";

const SVG = "http://www.w3.org/2000/svg";
const PIXELS_PER_DEG = 2.2;
const SAY_EVERY_MS = 5000;
const SAY_FROM_DEG = 5;

function shape(name, attributes, parent, className = "") {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (className) node.setAttribute("class", className);
  parent.append(node);
  return node;
}

function ladder(parent) {
  for (let tens = -90; tens <= 90; tens += 5) {
    if (tens === 0) continue;
    const y = -tens * PIXELS_PER_DEG;
    const half = tens % 10 ? 11 : 24;
    shape("path", { d: `M${-half} ${y}H${half}` }, parent, "rung");
    if (tens % 10) continue;
    for (const side of [-1, 1]) {
      const said = shape("text", { x: side * (half + 12), y: y + 3 }, parent, "rung-said");
      said.textContent = Math.abs(tens);
    }
  }
}

function dial(parent) {
  for (const tick of [-60, -45, -30, -20, -10, 0, 10, 20, 30, 45, 60]) {
    const length = tick % 30 === 0 ? 10 : 6;
    shape("path", { d: `M0 -102v${-length}`, transform: `rotate(${tick})` }, parent, "tick");
  }
}

export class Horizon {
  constructor(axes) {
    this.axes = axes;
    this.said = { at: -Infinity, roll: NaN, pitch: NaN };
    this.world = this.build(byId("horizon"));
    this.rows = axes.map((axis) => this.row(axis));
  }

  build(box) {
    const svg = shape("svg", { viewBox: "-130 -120 260 240", "aria-hidden": "true" }, box);
    const sky = shape("g", {}, svg);
    shape("rect", { x: -400, y: -700, width: 800, height: 700 }, sky, "sky");
    shape("rect", { x: -400, y: 0, width: 800, height: 700 }, sky, "ground");
    shape("path", { d: "M-400 0H400" }, sky, "skyline");
    const rungs = this.clipped(svg);
    ladder(rungs);
    this.ghost = shape("path", { d: "M-400 0H400" }, svg, "ghost");
    dial(svg);
    this.pointer = shape("path", { d: "M0 -101l-6 11h12z" }, svg, "pointer");
    shape("path", { d: "M-62 0h34l8 8M62 0h-34l-8 8" }, svg, "craft");
    shape("circle", { r: 2.5 }, svg, "craft-dot");
    return [sky, rungs];
  }

  /** The rungs end below the dial. */
  clipped(svg) {
    const clip = shape("clipPath", { id: "horizon-clip" }, svg);
    shape("circle", { r: 84 }, clip);
    return shape("g", {}, shape("g", { "clip-path": "url(#horizon-clip)" }, svg));
  }

  row(axis) {
    const line = element("tr");
    const name = element("th", { said: axis[0].toUpperCase() + axis.slice(1), className: axis });
    name.scope = "row";
    const cells = ["device", "model", "residual"].map((kind) => element("td", { className: kind }));
    line.append(name, ...cells);
    byId("digits").append(line);
    return { axis, cells };
  }

  show(sample) {
    if (!sample) return;
    const of = (axis, kind) => (Number.isFinite(sample[axis]?.[kind]) ? sample[axis][kind] : 0);
    for (const part of this.world) this.turn(part, of("roll", "device"), of("pitch", "device"));
    const known = this.axes.every((axis) => Number.isFinite(sample[axis].model));
    this.ghost.style.visibility = known ? "visible" : "hidden";
    if (known) this.turn(this.ghost, of("roll", "model"), of("pitch", "model"));
    this.pointer.setAttribute("transform", `rotate(${(-of("roll", "device")).toFixed(2)})`);
    this.digits(sample);
    this.say(sample);
  }

  /** Right side down turns the world to the left; nose down (pitch above 0) lifts it. */
  turn(node, roll, pitch) {
    const up = (-pitch * PIXELS_PER_DEG).toFixed(2);
    node.setAttribute("transform", `rotate(${(-roll).toFixed(2)}) translate(0 ${up})`);
  }

  digits(sample) {
    for (const { axis, cells } of this.rows) {
      const { device, model, residual } = sample[axis];
      text(cells[0], `${angle(device)}°`);
      text(cells[1], `${angle(model)}°`);
      text(cells[2], `${degrees(residual)}°`);
    }
  }

  /** Tell a screen reader where it stands, but only after a real change, and not too often. */
  say(sample) {
    const now = performance.now();
    const moved = this.axes.some(
      (axis) => !(Math.abs(sample[axis].device - this.said[axis]) < SAY_FROM_DEG),
    );
    if (!moved || now - this.said.at < SAY_EVERY_MS) return;
    this.said = { at: now };
    for (const axis of this.axes) this.said[axis] = sample[axis].device;
    const words = this.axes.map((axis) => `${axis} ${sample[axis].device.toFixed(0)} degrees`);
    text(byId("attitude-said"), words.join(", "));
    byId("horizon").setAttribute("aria-label", `Artificial horizon: ${words.join(", ")}`);
  }
}
