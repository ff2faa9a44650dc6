// The time constant of the filter: as tau, as eta, and as a slider that is even in its logarithm.

import { post } from "./api.js";
import { attempt, byId, text } from "./dom.js";
import { figure } from "./format.js";
import { TAU, differs, outcome } from "./parameters.js";

const LOWEST_S = 0.01;
const HIGHEST_S = 30;

export class Tau {
  constructor(rateHz) {
    this.periodS = 1 / rateHz;
    this.dirty = false;
    this.refused = false;
    this.form = byId("tau");
    this.tau = byId("tau-value");
    this.eta = byId("tau-eta");
    this.slide = byId("tau-slide");
    this.tau.addEventListener("input", () => this.edit(this.tau.valueAsNumber, this.tau));
    this.eta.addEventListener("input", () => this.edit(this.ofEta(this.eta.valueAsNumber), this.eta));
    this.slide.addEventListener("input", () => {
      this.edit(10 ** this.slide.valueAsNumber, this.slide);
    });
    this.form.addEventListener("submit", (event) => this.apply(event));
    byId("revert").addEventListener("click", () => { this.dirty = false; });
  }

  ofEta(eta) { return (eta * this.periodS) / (1 - eta); }

  etaOf(tau) { return tau / (tau + this.periodS); }

  edit(tau, source) {
    this.dirty = true;
    this.fill(tau, source);
  }

  /** Show one value in all three places, except where it is being typed. */
  fill(tau, source = null) {
    if (!Number.isFinite(tau) || tau <= 0) return;
    if (source !== this.tau) this.tau.value = Number(tau.toPrecision(5));
    if (source !== this.eta) this.eta.value = Number(this.etaOf(tau).toPrecision(6));
    if (source !== this.slide) this.slide.value = Math.log10(tau);
    this.slide.setAttribute("aria-valuetext", `${figure(tau, 3)} s`);
  }

  async apply(event) {
    event.preventDefault();
    const value = this.tau.valueAsNumber;
    const send = () => post("parameters", { name: TAU, value });
    this.refused = !(await attempt(byId("tau-said"), send));
    if (!this.refused) this.dirty = false;
  }

  show(parameters, settable) {
    byId("tau-apply").disabled = !settable;
    const parameter = parameters.find(({ name }) => name === TAU);
    this.form.hidden = !parameter;
    if (!parameter) return;
    this.limit(parameter);
    const busy = this.form.contains(document.activeElement) && document.activeElement.matches("input");
    if (!this.dirty && !busy && parameter.wanted === null) this.fill(parameter.value);
    const design = differs(parameter) ? ` · design ${figure(parameter.design_value)} s` : "";
    const used = byId("tau-used");
    text(used, `in use τ ${figure(parameter.value, 5)} s · η ${figure(this.etaOf(parameter.value), 4)}` +
      ` · ${figure(1 / (2 * Math.PI * parameter.value), 3)} Hz${design}`);
    used.classList.toggle("warn", Boolean(design));
    const { said, failed } = outcome(parameter);
    if (this.refused && !said) return;
    text(byId("tau-said"), said);
    byId("tau-said").classList.toggle("bad", failed);
  }

  limit({ lowest, highest }) {
    const least = Math.log10(lowest > 0 ? lowest : LOWEST_S).toFixed(3);
    const most = Math.log10(highest > 0 ? highest : HIGHEST_S).toFixed(3);
    if (this.slide.min !== least) this.slide.min = least;
    if (this.slide.max !== most) this.slide.max = most;
  }
}
