// Play, hold, speed and place of a replay.

import { post } from "./api.js";
import { attempt, byId, text } from "./dom.js";
import { clock } from "./format.js";

export class Replay {
  constructor() {
    this.paused = false;
    this.dragging = false;
    this.seek = byId("replay-seek");
    this.speed = byId("replay-speed");
    this.button = byId("replay-play");
    this.button.addEventListener("click", () => {
      this.ask({ action: this.paused ? "resume" : "pause" });
    });
    this.speed.addEventListener("change", () => {
      const value = this.speed.value === "max" ? null : Number(this.speed.value);
      this.ask({ action: "speed", value });
    });
    this.seek.addEventListener("input", () => {
      this.dragging = true;
      this.say(this.seek.valueAsNumber);
    });
    this.seek.addEventListener("change", () => {
      this.dragging = false;
      this.ask({ action: "seek", value: this.seek.valueAsNumber });
    });
  }

  ask(body) {
    return attempt(byId("replay-said"), () => post("replay", body));
  }

  show(state) {
    byId("replay").hidden = !state;
    if (!state) return;
    this.length = state.length_s;
    this.paused = state.paused;
    text(this.button, state.paused ? "Play" : "Pause");
    this.seek.max = state.length_s;
    if (!this.dragging) {
      this.seek.value = state.position_s;
      this.say(state.position_s, state.ended);
    }
    if (document.activeElement !== this.speed) {
      this.speed.value = state.speed === null ? "max" : String(state.speed);
    }
  }

  say(position, ended = false) {
    const said = `${clock(position)} of ${clock(this.length)}${ended ? ", at its end" : ""}`;
    text(byId("replay-position"), said);
    this.seek.setAttribute("aria-valuetext", said);
  }
}
