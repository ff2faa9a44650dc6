// The bar above and the slider below the charts.

import { byId, text } from "./dom.js";
import { fixed } from "./format.js";

export class Scrolling {
  constructor(view, store) {
    Object.assign(this, { view, store });
    this.slider = byId("scroll");
    this.hold = byId("hold");
    this.live = byId("live");
    this.span = byId("span");
    this.hold.addEventListener("click", () => view.hold(view.live));
    this.live.addEventListener("click", () => view.goLive());
    this.span.addEventListener("change", () => view.set(view.end, Number(this.span.value)));
    this.slider.addEventListener("input", () => this.slid());
  }

  slid() {
    const value = this.slider.valueAsNumber;
    if (value >= Number(this.slider.max) - 1e-3) this.view.goLive();
    else this.view.moveTo(value);
  }

  show() {
    const { view, store, slider } = this;
    const first = Math.min(store.lastX, store.firstX + view.spanS);
    slider.min = first;
    slider.max = store.lastX;
    slider.value = view.to;
    const behind = store.lastX - view.to;
    const said = view.live ? "live" : `${fixed(behind, 1)} s behind`;
    text(byId("scroll-said"), said);
    slider.setAttribute("aria-valuetext", said);
    this.hold.setAttribute("aria-pressed", String(!view.live));
    text(this.hold, view.live ? "Pause" : "Resume");
    this.live.disabled = view.live;
    if (this.span.value !== String(view.spanS)) this.span.value = view.spanS;
  }
}
