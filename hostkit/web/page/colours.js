// The colours of the style sheet, as a canvas needs them.

const NAMES = ["roll", "pitch", "ink", "soft", "line", "good", "bad", "band"];

/** Read them anew, after the theme has changed. */
export function readColours() {
  const probe = document.createElement("i");
  probe.hidden = true;
  document.body.append(probe);
  const colours = {};
  for (const name of NAMES) {
    probe.style.color = `var(--${name})`;
    colours[name] = getComputedStyle(probe).color;
  }
  probe.remove();
  return colours;
}
