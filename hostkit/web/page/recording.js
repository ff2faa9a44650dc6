// Starting and ending a recording, and those that are there.

import { post, recordings } from "./api.js";
import { attempt, byId, element, text } from "./dom.js";
import { bytes, count } from "./format.js";

function suggestion() {
  const now = new Date();
  const two = (value) => String(value).padStart(2, "0");
  const day = `${now.getFullYear()}${two(now.getMonth() + 1)}${two(now.getDate())}`;
  return `${day}-${two(now.getHours())}${two(now.getMinutes())}${two(now.getSeconds())}`;
}

export class Recording {
  constructor() {
    this.active = false;
    this.name = byId("recording-name");
    this.form = byId("recording-form");
    this.said = byId("recording-said");
    this.name.value = suggestion();
    byId("recording").addEventListener("submit", (event) => {
      event.preventDefault();
      attempt(this.said, () => post("recording", this.request()));
    });
    this.list();
  }

  request() {
    if (this.active) return { action: "stop", name: "" };
    const name = this.name.value.trim();
    const whole = /\.(tlog|csv|npz)$/.test(name) ? name : name + this.form.value;
    return { action: "start", name: whole };
  }

  show(state) {
    const active = Boolean(state?.active);
    if (this.active !== active) this.change(active);
    const size = state ? `${count(state.frames)} frames, ${bytes(state.written_bytes)}` : "";
    const node = byId("recording-state");
    text(node, !state ? "" : active ? `● ${state.name}: ${size}` : `${state.name} done: ${size}`);
    node.classList.toggle("bad", active);
    if (!state?.error) return;
    text(this.said, state.error);
    this.said.classList.add("bad");
  }

  change(active) {
    this.active = active;
    text(byId("recording-go"), active ? "Stop" : "Record");
    byId("recording-go").classList.toggle("danger", active);
    this.name.disabled = active;
    this.form.disabled = active;
    if (!active) this.name.value = suggestion();
    this.list();
  }

  async list() {
    let files;
    try {
      files = await recordings();
    } catch {
      return; // the banner says that the server is away
    }
    const node = byId("recordings");
    node.replaceChildren(...files.map((file) => this.entry(file)));
    if (!files.length) node.append(element("li", { className: "soft", said: "no recording yet" }));
  }

  entry({ name, bytes: size }) {
    const line = element("li");
    const link = element("a", { said: name, title: name });
    link.href = `/recordings/${encodeURIComponent(name)}`;
    link.download = name;
    line.append(link, element("span", { className: "soft", said: bytes(size) }));
    return line;
  }
}
