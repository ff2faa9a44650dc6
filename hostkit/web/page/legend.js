// Which line is which, and what the samples under the pointer are.

import { byId, element, text } from "./dom.js";
import { angle, degrees, fixed } from "./format.js";

export class Legend {
  constructor(axes) {
    this.axes = axes;
    this.readout = byId("readout");
    for (const axis of axes) this.entry(axis, axis);
    this.entry("dashed", "model");
  }

  entry(swatch, said) {
    const line = element("li");
    line.append(element("i", { className: `swatch ${swatch}` }), element("span", { said }));
    byId("legend").append(line);
  }

  show(sample, time) {
    this.readout.hidden = !sample;
    if (!sample) return;
    const parts = this.axes.map((axis) => {
      const { device, residual } = sample[axis];
      return `${axis} ${angle(device)}°, residual ${degrees(residual)}°`;
    });
    text(this.readout, [`${fixed(time, 3)} s`, ...parts].join(" · "));
  }
}
