// The parameters of the device: what is in use, what the design says, and setting another value.

import { post } from "./api.js";
import { attempt, byId, element, text } from "./dom.js";
import { figure, withUnit } from "./format.js";

/** Whether a parameter is shown with its views, in a place of its own. */
export function hasViews(parameter) { return (parameter.views ?? []).length > 0; }

/** Float32 values that stand for the same number. */
export function same(a, b) {
  return a === b || Math.abs(a - b) <= 2e-6 * Math.max(Math.abs(a), Math.abs(b));
}

export function differs(parameter) {
  return parameter.design_value !== null && !same(parameter.value, parameter.design_value);
}

/** What became of the last setting. */
export function outcome(parameter) {
  if (parameter.wanted !== null) {
    return { said: `asked for ${figure(parameter.wanted, 6)} …`, failed: false };
  }
  return { said: parameter.error ?? "", failed: Boolean(parameter.error) };
}

class Row {
  constructor(parameter) {
    this.name = parameter.name;
    this.dirty = false;
    this.refused = false;
    this.form = element("form", { className: "parameter" });
    const id = `parameter-${this.name}`;
    const label = element("label", { said: this.name, title: this.name });
    label.htmlFor = id;
    this.used = element("span", { className: "used" });
    this.input = element("input");
    Object.assign(this.input, { id, type: "number", step: "any", required: true });
    this.button = element("button", { said: "Apply" });
    this.button.setAttribute("aria-label", `Apply ${this.name}`);
    this.said = element("p", { className: "said" });
    this.said.setAttribute("aria-live", "polite");
    this.form.append(label, this.used, this.input, this.button, this.said);
    this.input.addEventListener("input", () => { this.dirty = true; });
    this.form.addEventListener("submit", (event) => this.apply(event));
  }

  async apply(event) {
    event.preventDefault();
    const value = this.input.valueAsNumber;
    this.refused = !(await attempt(this.said, () => post("parameters", { name: this.name, value })));
    if (!this.refused) this.dirty = false;
  }

  show(parameter, settable) {
    this.button.disabled = !settable;
    const used = withUnit(figure(parameter.value, 6), parameter.unit);
    const design = differs(parameter) ? ` (design ${figure(parameter.design_value)})` : "";
    text(this.used, used + design);
    this.used.classList.toggle("warn", Boolean(design));
    if (!this.dirty && document.activeElement !== this.input && parameter.wanted === null) {
      this.input.value = Number(parameter.value?.toPrecision(6));
    }
    const { said, failed } = outcome(parameter);
    if (this.refused && !said) return; // the server's answer stays
    text(this.said, said);
    this.said.classList.toggle("bad", failed);
  }
}

export class Parameters {
  constructor() {
    this.rows = new Map();
    const said = byId("parameters-said");
    byId("revert").addEventListener("click", () => {
      for (const row of this.rows.values()) row.dirty = false;
      attempt(said, () => post("parameters/revert"));
    });
  }

  /** `settable` is false where there is no device to set anything on. */
  show(parameters, settable) {
    byId("revert").disabled = !settable;
    byId("retuned").hidden = !parameters.some(differs);
    const viewed = parameters.find(hasViews);
    const listed = parameters.filter((parameter) => parameter !== viewed).slice(0, 256);
    const names = new Set(listed.map((parameter) => parameter.name));
    for (const [name, row] of this.rows) {
      if (names.has(name)) continue;
      row.form.remove();
      this.rows.delete(name);
    }
    for (const parameter of listed) this.row(parameter).show(parameter, settable);
  }

  row(parameter) {
    let row = this.rows.get(parameter.name);
    if (!row) {
      row = new Row(parameter);
      this.rows.set(parameter.name, row);
      byId("parameters").append(row.form);
    }
    return row;
  }
}
