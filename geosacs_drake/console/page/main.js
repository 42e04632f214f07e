// Wires the page: the link, the hands, what is shown.

import { Camera } from "./camera.js";
import { Devices } from "./devices.js";
import { Disk } from "./disk.js";
import { showEnd } from "./end.js";
import { Eye } from "./eye.js";
import { Gamepads } from "./gamepads.js";
import { Keys } from "./keys.js";
import { Link } from "./link.js";
import { Pad } from "./pad.js";
import { Scanning } from "./scanning.js";
import { onChange, settings, suggest } from "./settings.js";
import { openSettings } from "./settings_dialog.js";
import { clearHistory, showEvent, showStatus } from "./status.js";
import { Stick } from "./stick.js";

const byId = (id) => document.getElementById(id);

const link = new Link();
const stick = new Stick(link);
const disk = new Disk(byId("disk"), byId("disk-words"));
const camera = new Camera(byId("frame"), byId("view"));
const eye = new Eye(link, byId("eye"), byId("eye-figure"));
let status = null, about = {};

const press = (button) => {
  if (button !== "start") stick.centre();
  link.send({ type: "press", button });
};
new Pad(byId("pad"), byId("knob"), stick);
const scanning = new Scanning(stick, byId("pad"));
const keys = new Keys(stick, press, (event, down) => scanning.key(event, down));
const kept = new Map();
const gamepads = new Gamepads(stick, press, kept);
new Devices(byId("devices"), byId("binding"), gamepads, link);

for (const name of ["start", "stop", "gripper", "reverse"]) byId(name).addEventListener("click", () => press(name));
byId("take").addEventListener("click", () => {
  if (!status) return;
  const others = status.holder !== "" && status.holder !== link.you;
  stick.centre();
  link.send({ type: others ? "take" : !status.begun ? "watch" : status.person ? "hand_back" : "take" });
});
byId("settings").addEventListener("click", () => {
  stick.centre();
  openSettings(byId("settings-dialog"));
});

// Which way is right and up: told whenever it changes, or when this page comes to steer.
const follows = () => settings.view === "gripper" || eye.chosen;
const tellView = () => link.send({ type: "view", mapping: settings.mapping, seat: settings.seat, follow: follows(), ...camera.basis });
let mapped = "";
onChange(() => {
  gamepads.switched = scanning.on ? (name, down) => scanning.gamepad(name, down) : null;
  const now = `${settings.mapping} ${settings.seat} ${settings.view} ${eye.chosen}`;
  if (now === mapped) return;
  mapped = now;
  if (settings.view === "seat") camera.look();
  tellView();
});
gamepads.switched = scanning.on ? (name, down) => scanning.gamepad(name, down) : null;
camera.addEventListener("turned", () => { if (settings.mapping === "view") tellView(); });

// A button that a mouse has pressed gives the keys back.
document.addEventListener("click", (event) => {
  if (event.detail > 0) event.target.closest?.("button, summary")?.blur();
});

// The frame says when it begins; where that was before this script, it is there already.
window.listenToKeys = (target) => keys.listen(target);
keys.listen(byId("frame").contentWindow);

function meet(detail) {
  about = detail;
  document.title = about.description ?? "GeoSACS";
  suggest({ mapping: about.mapping, seat: about.seat });
  [camera.yaw, camera.position] = [about.base_yaw ?? 0, about.base ?? [0, 0, 0]];
  for (const { device, ...bindings } of Object.values(about.bindings ?? {})) if (!kept.has(device)) kept.set(device, bindings);
  camera.look();
  tellView();
}
link.addEventListener("about", ({ detail }) => meet(detail.about));  // of a run that was still being built
link.addEventListener("welcome", ({ detail }) => {
  meet(detail.about);
  clearHistory();
  detail.history.forEach(showEvent);
  notice("");
  if (document.body.dataset.ended && !detail.end) location.reload();  // it runs again: begin with a clean page
  byId("end").close();
  if (detail.end) showEnd(detail.end, link);
});
link.addEventListener("status", ({ detail }) => {
  if (detail.teaching) location.reload();  // a lesson has a page of its own
  if (!detail.axes) {  // the robot is still being built
    document.getElementById("headline").textContent = "Getting ready";
    return;
  }
  if (status && status.holder !== detail.holder && detail.holder === link.you) tellView();
  status = detail;
  showStatus(status, link.you);
  disk.show(status, settings.mapping === "view" ? camera.basis : null, settings.seat);
});
link.addEventListener("event", ({ detail }) => showEvent(detail));
link.addEventListener("told", ({ detail }) => notice(detail.text, 4000));
link.addEventListener("end", ({ detail }) => {
  document.body.dataset.ended = "yes";
  showEnd(detail, link);
});
link.addEventListener("lost", () => {
  stick.centre();
  const ended = document.body.dataset.ended;
  if (!byId("end").open && !ended) notice("No connection to the robot: the stick is at its centre. Trying again …");
});

let noticeTimer = null;
function notice(text, for_ms = 0) {
  clearTimeout(noticeTimer);
  const line = byId("link-notice");
  line.textContent = text;
  line.hidden = !text;
  if (text && for_ms) noticeTimer = setTimeout(() => notice(""), for_ms);
}
