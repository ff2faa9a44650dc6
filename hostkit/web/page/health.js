// Figures of the verdict, of the link and of the device.

import { byId, element, pairs, table, text } from "./dom.js";
import { bytes, clock, count, degrees, figure, fixed, withUnit } from "./format.js";

const bad = (value) => (value > 0 ? "bad" : "");
const warn = (value) => (value > 0 ? "warn" : "");

const FIGURES = [
  ["RMS °", (axis) => degrees(axis.rms_deg)],
  ["Mean °", (axis) => degrees(axis.mean_deg)],
  ["Median size °", (axis) => degrees(axis.p50_deg)],
  ["95 % below °", (axis) => degrees(axis.p95_deg)],
  ["99 % below °", (axis) => degrees(axis.p99_deg)],
  ["Largest °", (axis) => degrees(axis.max_deg)],
  ["Lag ms", (axis) => (axis.lag_s === null ? "–" : fixed(axis.lag_s * 1000, 1))],
  ["Drift °/min", (axis) => (axis.drift_deg_s === null ? "–" : degrees(axis.drift_deg_s * 60))],
];

export function showFigures(report) {
  const axes = report.residual ?? [];
  const rows = FIGURES.map(([name, said]) => [name, ...axes.map(said)]);
  if (!axes.length) {
    rows.splice(0, Infinity, ["RMS °", degrees(report.rms_deg)], ["Largest °", degrees(report.max_deg)]);
  }
  table(byId("figures"), ["", ...(axes.length ? axes.map(({ axis }) => axis) : ["all"])], rows);
  pairs(byId("counts"), [
    ["Samples", count(report.samples)],
    ["Checked", count(report.checked)],
    ["Mismatches", count(report.mismatches), bad(report.mismatches)],
    ["Lost", count(report.lost), warn(report.lost)],
    ["Late", count(report.late), warn(report.late)],
    ["Unjudged", count(report.unjudged), warn(report.unjudged)],
  ]);
  showRetuned(report.retuned ?? []);
}

function showRetuned(retuned) {
  const lines = retuned.map(({ name, device_value, design_value, unit }) =>
    `${name} ${withUnit(figure(device_value), unit)}, design ${figure(design_value)}`);
  const list = byId("retuned-list");
  while (list.children.length > lines.length) list.lastChild.remove();
  lines.forEach((said, index) => {
    if (!list.children[index]) list.append(element("li"));
    text(list.children[index], said);
  });
}

export function showLink(snapshot) {
  const { link, timing } = snapshot;
  const rate = `${count(snapshot.frames_per_s)} frames/s · ${count(snapshot.samples_per_s)} samples/s`;
  text(byId("link-rate"), `${rate} · ${bytes(Math.round(snapshot.bytes_per_s))}/s`);
  pairs(byId("link"), [
    ["Frames", count(link.frames)],
    ["Lost", count(link.lost_frames), warn(link.lost_frames)],
    ["Twice", count(link.duplicated), warn(link.duplicated), "frames that came again"],
    ["Reordered", count(link.reordered), warn(link.reordered)],
    ["CRC", count(link.crc_failures), bad(link.crc_failures), "frames with a wrong checksum"],
    ["Unknown", count(link.unknown), warn(link.unknown), "frames of an unknown message"],
    ["Resyncs", count(link.resyncs), warn(link.resyncs)],
    ["Bad bytes", count(link.bad_bytes), warn(link.bad_bytes)],
    ["Overrun", bytes(link.overrun_bytes), bad(link.overrun_bytes), "received, but dropped"],
    ["Latency", milliseconds(timing.latency), "", spread(timing.latency)],
    ["Jitter", milliseconds(timing.jitter), "", spread(timing.jitter)],
    ["Round trip", withUnit(fixed(timing.round_trip_ms, 1), "ms"), "", clockRate(timing)],
    ...optional("Signature", link.bad_signatures),
    ...optional("Page missed", snapshot.missed_batches),
  ]);
  showSources(link.sources ?? []);
  showForwards(snapshot.forwards ?? []);
}

function showForwards(forwards) {
  byId("forwards").hidden = !forwards.length;
  const rows = forwards.slice(0, 20).map((place) => [
    place.address,
    count(place.sent_frames),
    count(place.dropped_frames),
    count(place.received_frames),
  ]);
  table(byId("forwards"), ["Forwarded to", "sent", "dropped", "back"], rows);
}

function optional(name, value) {
  return value ? [[name, count(value), "bad"]] : [];
}

function milliseconds(spread_) {
  return withUnit(fixed(spread_?.median_ms, 1), "ms");
}

function spread(spread_) {
  if (!spread_) return "";
  return `median, 95 % ${fixed(spread_.p95_ms, 1)} ms, most ${fixed(spread_.max_ms, 1)} ms`;
}

function clockRate(timing) {
  return timing.clock_ppm === null ? "" : `the device's clock is ${fixed(timing.clock_ppm, 0)} ppm fast`;
}

function showSources(sources) {
  const rows = sources.slice(0, 50).map((source) => [
    `${source.system}/${source.component}`,
    count(source.frames),
    count(source.lost),
    count(source.duplicated),
    count(source.reordered),
    count(source.restarts),
  ]);
  table(byId("sources"), ["Sender", "frames", "lost", "twice", "reord.", "restarts"], rows);
}

const STATE_MARKS = { ACTIVE: "ok", CALIBRATING: "warn", BOOT: "warn", CRITICAL: "bad" };

export function showDevice(device) {
  const chip = byId("device-state");
  text(chip, device.state ?? "not heard");
  chip.className = `chip ${STATE_MARKS[device.state] ?? ""}`;
  const health = device.healthy === null ? "–" : device.healthy ? "good" : "bad";
  pairs(byId("device"), [
    ["Sensor", health, health === "bad" ? "bad" : ""],
    ["Temperature", withUnit(fixed(device.temperature_deg_c, 1), "°C")],
    ["Load", withUnit(fixed(device.load_percent, 0), "%"), device.load_percent > 90 ? "warn" : ""],
    ["Bus errors", count(device.bus_errors), bad(device.bus_errors)],
    ["Running", clock(device.uptime_s)],
    ["Version", device.version ?? "–", "", device.version ?? ""],
  ]);
}

