// Notices of hostkit and texts of the device in one list, newest first.

import { byId, element } from "./dom.js";
import { timeOfDay } from "./format.js";

let shown = "";

export function showMessages(snapshot) {
  const key = JSON.stringify([snapshot.notices, snapshot.device.texts]);
  if (key === shown) return;
  shown = key;
  const notices = [...snapshot.notices].reverse().map(notice);
  const texts = [...snapshot.device.texts].reverse().map(deviceText);
  const list = byId("messages");
  list.replaceChildren(...notices, ...texts);
  if (!list.children.length) list.append(element("li", { className: "soft", said: "none yet" }));
}

function notice({ time_s, level, text }) {
  const line = element("li", { className: level });
  line.append(
    element("time", { said: timeOfDay(time_s) }),
    element("span", { className: "level", said: level }),
    element("span", { said: text, title: text }),
  );
  return line;
}

function deviceText(said) {
  const line = element("li", { className: "device" });
  line.append(
    element("span", { className: "level", said: "device" }),
    element("span", { said, title: said }),
  );
  return line;
}
