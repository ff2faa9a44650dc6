// Which line is which, and what it says under the pointer.

import { byId, element, text } from "./dom.js";
import { angle } from "./format.js";

export class Legend {
  constructor(axes) {
    this.entries = axes.map((axis) => ({ axis, value: this.entry(axis, axis) }));
    this.entry("dashed", "model");
  }

  entry(swatch, said) {
    const line = element("li");
    const value = element("span", { className: "value" });
    line.append(element("i", { className: `swatch ${swatch}` }), element("span", { said }), value);
    byId("legend").append(line);
    return value;
  }

  show(sample) {
    for (const { axis, value } of this.entries) {
      const { device, model } = sample?.[axis] ?? {};
      text(value, sample ? `${angle(device)}° (${angle(model)}°)` : "");
    }
  }
}
