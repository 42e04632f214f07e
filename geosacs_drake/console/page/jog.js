// The stick of a lesson: the pad's two directions and the lift's one become a motion of the tool in the robot's frame.

import { settings } from "./settings.js";
import { Stick, turned } from "./stick.js";
import { Ways } from "./ways.js";

const add = (...parts) => parts.reduce((a, b) => a.map((v, i) => v + b[i]));
const times = (k, v) => v.map((x) => k * x);
const short = (v) => v.map((x) => Math.round(1000 * x) / 1000);
const UP = [0, 0, 1];
const LIFTED = 0.5;  // an eye that looks down by less than 60° sees the vertical as up

// Up in the picture, as the vertical where that is seen as up: down ends with the nose straight down, and up leads from
// there away from the eye.
function nearlyUp(up, away, y) {
  if (up[2] < LIFTED) return up;
  const way = y > 0 ? add(UP, times(0.3, away)) : UP;
  return times(1 / Math.hypot(...way), way);
}

export class Jog extends Stick {
  // `basis` says what is right and up in the picture, in the robot's base frame.
  constructor(link, basis) {
    super(link);
    this.basis = basis;
    this.mode = "move";
    this.z = 0;
    // The lift as a stick of one direction, for ways and switches.
    const lift = new EventTarget();
    lift.hold = (source, x, z) => this.lift(z);
    lift.wake = () => this.wake();
    lift.step = (x, z) => this.sendStep([0, 0], z);
    this.lifts = new Ways(lift, "lift");
    this.addEventListener("centre", () => lift.dispatchEvent(new Event("centre")));
  }

  get rests() {
    return super.rests && this.z === 0;
  }

  centre() {
    const lifted = this.z !== 0;
    this.z = 0;
    super.centre();
    if (lifted) this.send();
  }

  change(mode) {
    this.centre();
    this.mode = mode;
  }

  lift(z) {
    z = Math.round(1000 * z * settings.sensitivity) / 1000;
    if (z === this.z) return;
    this.z = z;
    this.silent = 0;
    this.send();
    this.dispatchEvent(new Event("change"));
  }

  send() {
    this.link.send({ type: "jog", ...this.motion(this.value, this.z) });
  }

  step(x, y) {
    this.sendStep(turned([x, y]), 0);
  }

  sendStep(stick, z) {
    this.link.send({ type: "jog", ...this.motion(stick, z), mm: settings.step_mm });
  }

  // Moving: right, away and up in the room. Turning: the gripper's nose tips right and up in the picture, and it spins.
  motion([x, y], z) {
    const { right, up } = this.basis();
    const flat = Math.hypot(right[0], right[1]);
    const [rx, ry] = flat > 0.1 ? [right[0] / flat, right[1] / flat] : [0, 1];
    const away = [-ry, rx, 0];
    if (this.mode === "turn") return { nose: short(add(times(x, right), times(y, nearlyUp(up, away, y)))), spin: z };
    return { move: short(add(times(x, [rx, ry, 0]), times(y, away), times(z, UP))) };
  }
}

// A button that acts while it is held: by pointer, by key, by a switch, or tapped by a program that only clicks.
const TAP_MS = 120;

export function holds(button, id, way, ways) {
  const push = () => {
    button.classList.add("pushed");
    ways.push(id, way);
  };
  const release = () => {
    button.classList.remove("pushed");
    ways.release(id);
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "mouse" && event.button !== 0) return;
    button.setPointerCapture(event.pointerId);
    push();
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture", "letgo"]) button.addEventListener(name, release);
  button.addEventListener("hold", push);
  button.addEventListener("keydown", (event) => {
    if (!["Space", "Enter"].includes(event.code)) return;
    event.preventDefault();
    if (!event.repeat) push();
  });
  button.addEventListener("keyup", release);
  button.addEventListener("blur", release);
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  button.addEventListener("click", (event) => {
    if (event.detail > 0) return;
    push();
    setTimeout(release, TAP_MS);
  });
}
