// The head of the page: port, device, design, epoch, and the verdict with its reasons.

import { byId, element, text } from "./dom.js";
import { clock, figure, withUnit } from "./format.js";

const FACTS = 2;

const PORT_MARKS = { connected: "ok", lost: "bad", released: "warn", ended: "" };

export function showInfo(info) {
  text(byId("port-name"), info.port);
  byId("port-name").title = info.port;
  const node = byId("design-name");
  text(byId("design-digest"), info.design_digest);
  const facts = info.facts.map((fact) => factSaid(fact, 4));
  text(node, [...facts.slice(0, FACTS), `${figure(info.rate_hz)} Hz`].join(" · "));
  const all = info.facts.map((fact) => factSaid(fact, 6));
  node.title = [info.filter, ...all, `hostkit ${info.hostkit_version}`].join(", ");
}

function factSaid({ label, value, unit }, digits) {
  return `${label} ${withUnit(figure(value, digits), unit)}`;
}

/** What the badge says: nothing is judged before a step could be checked. */
export function verdictOf(report) {
  if (report.verdict === "refused") return "refused";
  return report.checked === 0 ? "waiting" : report.verdict;
}

export function showHead(snapshot) {
  const { report, device } = snapshot;
  const chip = byId("port-state");
  text(chip, snapshot.port_state);
  chip.className = `chip ${PORT_MARKS[snapshot.port_state] ?? ""}`;
  text(byId("device-name"), deviceName(device));
  text(byId("epoch"), `epoch ${snapshot.epoch}`);
  const again = snapshot.reconnects;
  text(byId("reconnects"), again ? `, ${again}× reconnected` : "");
  text(byId("elapsed"), clock(snapshot.elapsed_s) + (snapshot.ended ? " · ended" : ""));
  showVerdict(verdictOf(report), report.reasons ?? []);
}

function deviceName(device) {
  if (device.system === null) return "not heard yet";
  const version = device.version ? ` · ${device.version}` : "";
  return `${device.system}/${device.component}${version}`;
}

function showVerdict(verdict, reasons) {
  const said = verdict.toUpperCase();
  text(byId("verdict"), said);
  byId("verdict-box").dataset.verdict = verdict;
  const title = `${said} · hostkit monitor`;
  if (document.title !== title) document.title = title;
  const place = reasons.length > 1 ? `(1 of ${reasons.length}) ` : "";
  const first = byId("reason");
  text(first, place + (reasons[0] ?? why(verdict)));
  first.title = reasons.join("\n");
  const list = byId("reasons");
  if (list.dataset.shown === JSON.stringify(reasons)) return;
  list.dataset.shown = JSON.stringify(reasons);
  list.replaceChildren(...reasons.map((reason) => element("li", { said: reason })));
}

function why(verdict) {
  if (verdict === "waiting") return "no step could be checked yet";
  return verdict === "pass" ? "device and models agree" : "";
}
