// What stands in the way, across the whole page: the server first, then the device's port.

import { byId, text } from "./dom.js";

const STREAM = {
  lost: "No connection to hostkit: the figures below are old. Trying again …",
  ended: "The session has ended. The figures are final.",
};
const PORT = {
  lost: "The port is lost; hostkit tries again.",
  released: "The port is released.",
};

export class Banner {
  constructor() {
    this.stream = "";
    this.port = "";
  }

  showStream(state) {
    this.stream = STREAM[state] ?? "";
    document.body.dataset.stream = state;
    this.show();
  }

  showPort({ port_state, ended }) {
    this.port = ended ? "" : (PORT[port_state] ?? "");
    document.body.dataset.port = port_state;
    this.show();
  }

  show() { say(this.stream || this.port); }
}

/** Show a banner; an empty one goes away. */
export function say(said) {
  const node = byId("banner");
  node.hidden = !said;
  text(node, said);
}
