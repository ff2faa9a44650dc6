// What stands in place of a picture while there is no sample.

import { byId, text } from "./dom.js";

export function showEmpty({ report }, samples) {
  const node = byId("empty");
  node.hidden = samples > 0;
  document.body.dataset.samples = samples > 0 ? "some" : "none";
  const why = report.verdict === "refused" ? (report.reasons ?? [])[0] : null;
  text(node, why ? `Nothing to draw: ${why}` : "No sample yet");
}
