// Wires the page: the link, the hands, what is shown.

import { Disk, SEATS } from "./disk.js";
import { showEnd } from "./end.js";
import { Keys } from "./keys.js";
import { Link } from "./link.js";
import { Pad } from "./pad.js";
import { settings } from "./settings.js";
import { clearHistory, showEvent, showStatus } from "./status.js";
import { Stick } from "./stick.js";

const byId = (id) => document.getElementById(id);

const link = new Link();
const stick = new Stick(link);
const disk = new Disk(byId("disk"), byId("disk-words"));
let status = null, about = {};

const press = (button) => {
  if (button !== "start") stick.centre();
  link.send({ type: "press", button });
};
const keys = new Keys(stick, press);
new Pad(byId("pad"), byId("knob"), stick);

for (const name of ["start", "stop", "gripper", "reverse"]) byId(name).addEventListener("click", () => press(name));
byId("take").addEventListener("click", () => {
  if (!status) return;
  const others = status.holder !== "" && status.holder !== link.you;
  stick.centre();
  link.send({ type: others ? "take" : !status.begun ? "watch" : status.person ? "hand_back" : "take" });
});
// A button that a mouse has pressed gives the keys back.
document.addEventListener("click", (event) => {
  if (event.detail > 0) event.target.closest?.("button, summary")?.blur();
});

const frame = byId("frame");
frame.addEventListener("load", () => keys.listen(frame.contentWindow));

link.addEventListener("welcome", ({ detail }) => {
  about = detail.about;
  document.title = `${about.description ?? "GeoSACS"}`;
  clearHistory();
  detail.history.forEach(showEvent);
  notice("");
  byId("end").close();
  if (detail.end) showEnd(detail.end, link);
});
link.addEventListener("status", ({ detail }) => {
  if (!detail.axes) {  // the robot is still being built
    document.getElementById("headline").textContent = "Getting ready";
    return;
  }
  status = detail;
  showStatus(status, link.you);
  disk.show(status, SEATS[settings.seat]);
});
link.addEventListener("event", ({ detail }) => showEvent(detail));
link.addEventListener("told", ({ detail }) => notice(detail.text, 4000));
link.addEventListener("end", ({ detail }) => showEnd(detail, link));
link.addEventListener("lost", () => {
  stick.centre();
  if (!byId("end").open) notice("No connection to the robot: the stick is at its centre. Trying again …");
});

let noticeTimer = null;
function notice(text, for_ms = 0) {
  clearTimeout(noticeTimer);
  const line = byId("link-notice");
  line.textContent = text;
  line.hidden = !text;
  if (text && for_ms) noticeTimer = setTimeout(() => notice(""), for_ms);
}
