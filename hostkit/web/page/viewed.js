// The parameter that has views, such as a time constant that may be typed as eta instead: its value,
// its first view, and a slider that is even in the logarithm.

import { post } from "./api.js";
import { attempt, byId, text } from "./dom.js";
import { figure } from "./format.js";
import { differs, hasViews, outcome } from "./parameters.js";

const LOWEST = 0.01;
const HIGHEST = 30;
const VIEW_DIGITS = [4, 3];

/** A view is (a value + b) / (c value + d), and turned around. */
function viewOf({ terms: [a, b, c, d] }, value) { return (a * value + b) / (c * value + d); }

function valueOf({ terms: [a, b, c, d] }, shown) { return (d * shown - b) / (a - c * shown); }

function said(symbol, number, digits, unit) {
  return `${symbol} ${figure(number, digits)} ${unit}`.trim();
}

export class Viewed {
  constructor() {
    this.parameter = null;
    this.dirty = false;
    this.refused = false;
    this.form = byId("viewed");
    this.value = byId("viewed-value");
    this.other = byId("viewed-other");
    this.slide = byId("viewed-slide");
    this.value.addEventListener("input", () => this.edit(this.value.valueAsNumber, this.value));
    this.other.addEventListener("input", () => {
      this.edit(valueOf(this.parameter.views[0], this.other.valueAsNumber), this.other);
    });
    this.slide.addEventListener("input", () => {
      this.edit(10 ** this.slide.valueAsNumber, this.slide);
    });
    this.form.addEventListener("submit", (event) => this.apply(event));
    byId("revert").addEventListener("click", () => { this.dirty = false; });
  }

  edit(value, source) {
    this.dirty = true;
    this.fill(value, source);
  }

  /** Show one value in all three places, except where it is being typed. */
  fill(value, source = null) {
    if (!Number.isFinite(value) || value <= 0) return;
    const { unit, views } = this.parameter;
    if (source !== this.value) this.value.value = Number(value.toPrecision(5));
    if (source !== this.other) this.other.value = Number(viewOf(views[0], value).toPrecision(6));
    if (source !== this.slide) this.slide.value = Math.log10(value);
    this.slide.setAttribute("aria-valuetext", said("", value, 3, unit));
  }

  async apply(event) {
    event.preventDefault();
    const value = this.value.valueAsNumber;
    const send = () => post("parameters", { name: this.parameter.name, value });
    this.refused = !(await attempt(byId("viewed-said"), send));
    if (!this.refused) this.dirty = false;
  }

  show(parameters, settable) {
    byId("viewed-apply").disabled = !settable;
    const parameter = parameters.find(hasViews);
    this.form.hidden = !parameter;
    if (!parameter) return;
    this.parameter = parameter;
    this.name(parameter);
    this.limit(parameter);
    const busy = this.form.contains(document.activeElement) && document.activeElement.matches("input");
    if (!this.dirty && !busy && parameter.wanted === null) this.fill(parameter.value);
    this.use(parameter);
    const { said: told, failed } = outcome(parameter);
    if (this.refused && !told) return;
    text(byId("viewed-said"), told);
    byId("viewed-said").classList.toggle("bad", failed);
  }

  use({ name, symbol, unit, value, views, ...parameter }) {
    const own = said(symbol || name, value, 5, unit);
    const others = views.map((view, place) => {
      return said(view.symbol, viewOf(view, value), VIEW_DIGITS[Math.min(place, 1)], view.unit);
    });
    const design = differs({ value, ...parameter })
      ? [said("design", parameter.design_value, 4, unit)] : [];
    const used = byId("viewed-used");
    text(used, `in use ${[own, ...others, ...design].join(" · ")}`);
    used.classList.toggle("warn", design.length > 0);
  }

  name({ name, symbol, title, unit, views }) {
    const [{ symbol: other, name: otherName, unit: otherUnit }] = views;
    text(byId("viewed-symbol"), symbol || name);
    text(byId("viewed-unit"), unit);
    text(byId("viewed-other-symbol"), other || `${otherName} ${otherUnit}`.trim());
    text(byId("viewed-slide-name"), `${title || name}, logarithmic`);
  }

  limit({ lowest, highest }) {
    const least = Math.log10(lowest > 0 ? lowest : LOWEST).toFixed(3);
    const most = Math.log10(highest > 0 ? highest : HIGHEST).toFixed(3);
    if (this.slide.min !== least) this.slide.min = least;
    if (this.slide.max !== most) this.slide.max = most;
  }
}
