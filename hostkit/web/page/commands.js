// Buttons that ask the device, or hostkit, to do something.

import { post } from "./api.js";
import { attempt, byId, text } from "./dom.js";

const WORDS = { waiting: "asked …", "in progress": "working …", accepted: "done" };

export class Commands {
  constructor() {
    this.said = byId("command-said");
    this.shown = "";
    for (const button of document.querySelectorAll("[data-command]")) {
      button.addEventListener("click", () => this.pressed(button.dataset.command));
    }
    this.dialog = byId("reboot");
    this.dialog.addEventListener("close", () => {
      if (this.dialog.returnValue === "reboot") this.send("reboot");
    });
    this.port = byId("port-button");
    this.port.addEventListener("click", () => {
      attempt(byId("port-said"), () => post("port", { action: this.port.dataset.action }));
    });
    byId("judge-anew").addEventListener("click", () => {
      attempt(byId("judge-said"), () => post("verdict", { action: "restart" }));
    });
  }

  pressed(name) {
    if (name !== "reboot") {
      this.send(name);
      return;
    }
    this.dialog.returnValue = "";
    this.dialog.showModal();
  }

  send(name) {
    this.shown = "";
    attempt(this.said, () => post("command", { name }));
  }

  show(snapshot) {
    this.showPort(snapshot);
    this.showCommand(snapshot.command);
  }

  showPort({ port_state, replay, ended }) {
    const released = port_state === "released";
    this.port.dataset.action = released ? "take" : "release";
    text(this.port, released ? "Take" : "Release");
    this.port.title = released ? "Open the port again" : "Let another program have the port";
    const off = Boolean(replay) || ended;
    this.port.hidden = off;
    for (const button of document.querySelectorAll("[data-command]")) {
      button.disabled = off || port_state !== "connected";
    }
  }

  showCommand(command) {
    if (!command) return;
    const detail = command.detail ? `: ${command.detail}` : "";
    const said = `${command.name} ${WORDS[command.state] ?? command.state}${detail}`;
    if (said === this.shown) return; // an answer of the server stays until the device says more
    this.shown = said;
    text(this.said, said);
    this.said.classList.toggle("bad", ["refused", "no answer"].includes(command.state));
  }
}
