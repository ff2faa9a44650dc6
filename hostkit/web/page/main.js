// Puts the page together: samples go to the store, snapshots to the panels, and both to the eye.

import { session } from "./api.js";
import { Banner, say } from "./banner.js";
import { Charts } from "./charts.js";
import { Commands } from "./commands.js";
import { byId, text } from "./dom.js";
import { showEmpty } from "./empty.js";
import { showDevice, showFigures, showLink } from "./health.js";
import { Horizon } from "./horizon.js";
import { startDrag, startKeys } from "./keys.js";
import { Legend } from "./legend.js";
import { showMessages } from "./messages.js";
import { Painter } from "./painter.js";
import { Parameters } from "./parameters.js";
import { Recording } from "./recording.js";
import { Replay } from "./replay.js";
import { Scrolling } from "./scrolling.js";
import { Store } from "./store.js";
import { Stream } from "./stream.js";
import { startTheme } from "./theme.js";
import { showHead, showInfo } from "./verdict.js";
import { View } from "./view.js";
import { Viewed } from "./viewed.js";

const LATENCIES = 1000;

/** What tests and benchmarks read; kept small and plain. */
const seen = { frames: 0, samples: 0, latencyMs: [] };
window.hostkit = seen;

class Page {
  constructor(info, uPlot) {
    const axes = [...info.axes];
    this.arrivedMs = null;
    this.store = new Store(axes, info.rate_hz);
    this.painter = new Painter(() => this.paint());
    this.view = new View(this.store, () => this.painter.request());
    this.scrolling = new Scrolling(this.view, this.store);
    this.horizon = new Horizon(axes);
    this.legend = new Legend(axes);
    this.banner = new Banner();
    this.panels = {
      parameters: new Parameters(),
      viewed: new Viewed(),
      commands: new Commands(),
      recording: new Recording(),
      replay: new Replay(),
    };
    this.charts = uPlot ? this.chartsOf(uPlot) : null;
    byId("missing").hidden = Boolean(uPlot);
    byId("plots").hidden = !uPlot;
    startKeys(this.view);
    startDrag(this.view, byId("plots"));
    this.info(info);
  }

  chartsOf(uPlot) {
    return new Charts(uPlot, {
      store: this.store,
      view: this.view,
      boxes: { angle: byId("angle-chart"), residual: byId("residual-chart") },
      cursor: (sample) => this.legend.show(sample, this.store.timeAt(sample?.x)),
      drawn: () => this.drawn(),
    });
  }

  info(info) {
    showInfo(info);
    if (this.charts) text(byId("band-said"), this.charts.allow(info));
  }

  samples(event, live) {
    this.store.append(event);
    seen.samples = this.store.total;
    if (live) this.arrivedMs = event.received_ms;
    this.painter.request();
  }

  snapshot(snapshot) {
    showHead(snapshot);
    this.banner.showPort(snapshot);
    showEmpty(snapshot, this.store.length);
    showFigures(snapshot.report);
    showLink(snapshot);
    showDevice(snapshot.device);
    showMessages(snapshot);
    const settable = !snapshot.replay && !snapshot.ended && snapshot.port_state === "connected";
    this.panels.parameters.show(snapshot.parameters, settable);
    this.panels.viewed.show(snapshot.parameters, settable);
    this.panels.commands.show(snapshot);
    this.panels.recording.show(snapshot.recording);
    this.panels.replay.show(snapshot.replay);
  }

  paint() {
    this.horizon.show(this.store.latest());
    this.scrolling.show();
    if (!this.charts) {
      this.drawn();
      return;
    }
    this.charts.draw();
    byId("marks-said").hidden = !this.charts.rows.mismatches.length;
  }

  drawn() {
    seen.frames++;
    if (this.arrivedMs === null) return;
    seen.latencyMs.push(Date.now() - this.arrivedMs);
    if (seen.latencyMs.length > LATENCIES) seen.latencyMs.shift();
    this.arrivedMs = null;
  }

  state(state) {
    if (state === "open") this.store.rejoin();
    this.banner.showStream(state);
  }

  recolour() { this.charts?.recolour(); }
}

async function charting() {
  try {
    return (await import("/vendor/uPlot.esm.js")).default;
  } catch {
    return null;
  }
}

async function start() {
  let page = null;
  startTheme(() => page?.recolour());
  try {
    const [{ info }, uPlot] = await Promise.all([session(), charting()]);
    page = new Page(info, uPlot);
  } catch (error) {
    say(`This page cannot start: ${error.message}`);
    return;
  }
  new Stream({
    samples: (event, live) => page.samples(event, live),
    snapshot: (event) => page.snapshot(event),
    info: (event) => page.info(event),
    state: (state) => page.state(state),
  });
}

start();
