// Which line is which, and what it says under the pointer.

import { byId, element, text } from "./dom.js";
import { angle } from "./format.js";

export class Legend {
  constructor(axes) {
    this.entries = axes.flatMap((axis) => [this.entry(axis, "device"), this.entry(axis, "model")]);
  }

  entry(axis, kind) {
    const line = element("li");
    const value = element("span", { className: "value" });
    line.append(
      element("i", { className: `swatch ${kind === "model" ? "dashed" : axis}` }),
      element("span", { said: `${axis} ${kind}` }),
      value,
    );
    byId("legend").append(line);
    return { axis, kind, value };
  }

  show(sample) {
    for (const { axis, kind, value } of this.entries) {
      text(value, sample ? `${angle(sample[axis][kind])}°` : "");
    }
  }
}
