// The keyboard and the pointer on the charts.

import { byId } from "./dom.js";

const OWN_KEYS = "input, select, textarea, button, a, dialog, .scroll";

export function startKeys(view) {
  const help = byId("keys");
  byId("keys-open").addEventListener("click", () => help.showModal());
  const actions = {
    " ": () => view.hold(view.live),
    ArrowLeft: (event) => view.scroll(event.shiftKey ? -1 : -0.1),
    ArrowRight: (event) => view.scroll(event.shiftKey ? 1 : 0.1),
    "+": () => view.zoom(-1),
    "=": () => view.zoom(-1),
    "-": () => view.zoom(1),
    Home: () => view.goLive(),
    "?": () => help.showModal(),
  };
  document.addEventListener("keydown", (event) => {
    // A control that has the focus keeps its keys.
    if (event.target.closest(OWN_KEYS) || event.ctrlKey || event.altKey || event.metaKey) return;
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}

/** Let a drag across the charts move them. */
export function startDrag(view, box) {
  let from = null;
  box.addEventListener("pointerdown", (event) => {
    if (event.button === 0) from = { x: event.clientX, end: view.to };
  });
  box.addEventListener("pointermove", (event) => {
    if (!from || Math.abs(event.clientX - from.x) < 4) return;
    box.setPointerCapture(event.pointerId);
    view.moveTo(from.end - ((event.clientX - from.x) / box.clientWidth) * view.spanS);
  });
  for (const kind of ["pointerup", "pointercancel"]) {
    box.addEventListener(kind, () => { from = null; });
  }
}
