// Wires the page of a lesson: the hands that move the gripper, the recorder's buttons, what was taught.

import { Camera } from "./camera.js";
import { Devices } from "./devices.js";
import { Eye } from "./eye.js";
import { Gamepads } from "./gamepads.js";
import { Jog, holds } from "./jog.js";
import { Keys } from "./keys.js";
import { Link } from "./link.js";
import { Pad } from "./pad.js";
import { Scanning } from "./scanning.js";
import { onChange, settings } from "./settings.js";
import { openSettings } from "./settings_dialog.js";
import { clearHistory, showEvent } from "./status.js";
import { showLesson } from "./lesson.js";

const byId = (id) => document.getElementById(id);
const LESSON = ["mode", "step_mm", "sensitivity", "seat", "dead_zone", "invert_x", "invert_y", "scanning", "dwell_s"];

const link = new Link();
const camera = new Camera(byId("frame"), byId("view"));
const eye = new Eye(link, byId("eye"), byId("eye-figure"));
let status = null, about = {};
const jog = new Jog(link, () => (settings.view === "gripper" || eye.chosen ? ofGripper() : null) ?? camera.basis ?? { right: [0, 1, 0], up: [0, 0, 1] });

// What is right and up in the picture of the camera on the gripper.
function ofGripper() {
  if (!status || !about.gripper_view) return null;
  const inBase = (v) => status.R_BT.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
  return { right: inBase(about.gripper_view.right), up: inBase(about.gripper_view.up) };
}

const say = (word) => link.send({ type: "teach", word });
const acts = {
  gripper: () => link.send({ type: "press", button: "gripper" }),
  stop: () => { jog.centre(); link.send({ type: "press", button: "stop" }); },
  start: () => link.send({ type: "press", button: "start" }),
  record: () => say(status?.recording ? "pause" : "record"),
};
for (const word of ["undo", "save", "back", "discard", "reset", "learn", "travel"]) acts[word] = () => { jog.centre(); say(word); };
for (const [name, act] of Object.entries(acts)) byId(name).addEventListener("click", act);

// The four buttons that every device has.
const press = (name) => ({ ...acts, reverse: acts.undo, start: () => (status?.stopped ? acts.start() : acts.record()) })[name]();

function change(mode) {
  jog.change(mode);
  const turns = mode === "turn";
  byId("mode-move").setAttribute("aria-checked", String(!turns));
  byId("mode-turn").setAttribute("aria-checked", String(turns));
  byId("raise").textContent = turns ? "Spin left" : "Raise";
  byId("lower").textContent = turns ? "Spin right" : "Lower";
  byId("pad-words").textContent = turns ? "The fingers tip the way the stick points." : "The stick moves to the sides, away and near.";
}
byId("mode-move").addEventListener("click", () => change("move"));
byId("mode-turn").addEventListener("click", () => change("turn"));
change("move");

const LIFT = { raise: [0, 1], lower: [0, -1] };
const LIFT_KEYS = { KeyE: "raise", PageUp: "raise", KeyQ: "lower", PageDown: "lower" };
for (const [name, way] of Object.entries(LIFT)) holds(byId(name), name, way, jog.lifts);

function lift(name, on) {
  if (on) jog.lifts.push(name, LIFT[name]);
  else jog.lifts.release(name);
}

function lessonKey(event, down) {
  const busy = document.querySelector("dialog[open]") || event.target?.matches?.("input, select, textarea");
  const way = LIFT_KEYS[event.code];
  if (way) {
    if (!event.repeat && !(busy && down)) lift(way, down);
    return !busy;
  }
  if (event.code !== "KeyM" || busy) return false;
  if (down && !event.repeat) change(jog.mode === "move" ? "turn" : "move");
  return true;
}

new Pad(byId("pad"), byId("knob"), jog);
const scanning = new Scanning(jog, byId("pad"));
const keys = new Keys(jog, press, (event, down) => scanning.key(event, down) || lessonKey(event, down));
const kept = new Map();
const gamepads = new Gamepads(jog, press, kept);
gamepads.more = (name, on) => {
  if (name in LIFT) lift(name, on);
  else if (on) change(jog.mode === "move" ? "turn" : "move");
};
new Devices(byId("devices"), byId("binding"), gamepads, link);

byId("settings").addEventListener("click", () => {
  jog.centre();
  openSettings(byId("settings-dialog"), LESSON);
});
const switches = () => { gamepads.switched = scanning.on ? (name, down) => scanning.gamepad(name, down) : null; };
let seen = "";
onChange(() => {
  switches();
  if (seen !== settings.seat && settings.view === "seat") camera.look();
  seen = settings.seat;
});
switches();

document.addEventListener("click", (event) => {
  if (event.detail > 0) event.target.closest?.("button, summary")?.blur();
});
// As in main.js: whichever of the two scripts comes second.
window.listenToKeys = (target) => keys.listen(target);
keys.listen(byId("frame").contentWindow);

function meet(detail) {
  about = detail;
  [camera.yaw, camera.position] = [about.base_yaw ?? 0, about.base ?? [0, 0, 0]];
  for (const { device, ...bindings } of Object.values(about.bindings ?? {})) if (!kept.has(device)) kept.set(device, bindings);
  camera.look();
}
link.addEventListener("about", ({ detail }) => meet(detail.about));
link.addEventListener("welcome", ({ detail }) => {
  meet(detail.about);
  clearHistory();
  detail.history.forEach(showEvent);
  notice("");
});
link.addEventListener("status", ({ detail }) => {
  if (detail.axes) location.reload();  // it is travelled now: that has a page of its own
  if (!detail.teaching) {
    byId("headline").textContent = "Getting ready";
    return;
  }
  status = detail;
  showLesson(status, link.you);
});
link.addEventListener("event", ({ detail }) => { showEvent(detail); notice(detail.text, 6000); });
link.addEventListener("told", ({ detail }) => notice(detail.text, 4000));
link.addEventListener("lost", () => {
  jog.centre();
  notice("No connection to the robot: the stick is at its centre. Trying again …");
});

let timer = null;
function notice(text, for_ms = 0) {
  clearTimeout(timer);
  const line = byId("link-notice");
  line.textContent = text;
  line.hidden = !text;
  if (text && for_ms) timer = setTimeout(() => notice(""), for_ms);
}
