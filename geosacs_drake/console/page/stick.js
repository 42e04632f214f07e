// One stick from many hands: the latest mover wins. What is held is said again, so that silence means the centre.

import { settings } from "./settings.js";

const REPEAT_MS = 50;
const ASLEEP_MS = 3000;  // who was stopped for so long does not know what became of the hands

export class Stick extends EventTarget {
  constructor(link) {
    super();
    this.link = link;
    this.sources = new Map();
    this.active = null;
    this.value = [0, 0];
    this.silent = 0;
    this.awake = performance.now();
    setInterval(() => this.repeat(), REPEAT_MS);
    for (const [target, event] of [[window, "blur"], [window, "pagehide"], [document, "visibilitychange"], [document, "freeze"]])
      target.addEventListener(event, () => { if (event !== "visibilitychange" || document.hidden) this.centre(); });
  }

  // A source says where it holds the stick: right and up, in the unit disc.
  hold(source, x, y) {
    if (this.wake()) return;
    const before = this.sources.get(source) ?? [0, 0];
    if (before[0] === x && before[1] === y) return;
    this.sources.set(source, [x, y]);
    const rests = x === 0 && y === 0;
    if (!rests) this.active = source;
    else if (this.active === source) this.active = null;
    else return;
    this.set(rests ? [0, 0] : shaped([x, y]));
  }

  // Everything falls to its centre; sources are told to let go.
  centre() {
    this.sources.clear();
    this.active = null;
    this.set([0, 0]);
    this.dispatchEvent(new Event("centre"));
  }

  // Asked before anything is said: which timer is the first after a sleep is chance. Says whether there was one.
  wake() {
    const slept = performance.now() - this.awake;
    this.awake = performance.now();
    if (slept > ASLEEP_MS) this.centre();
    return slept > ASLEEP_MS;
  }

  set(value) {
    const changed = value[0] !== this.value[0] || value[1] !== this.value[1];
    this.value = value;
    if (!changed) return;
    this.silent = 0;
    this.send();
    this.dispatchEvent(new Event("change"));
  }

  get rests() {
    return this.value[0] === 0 && this.value[1] === 0;
  }

  repeat() {
    this.wake();
    this.silent = this.rests ? this.silent + 1 : 0;
    if (this.silent <= 3) this.send();
  }

  send() {
    this.link.send({ type: "drive", stick: this.value });
  }

  // One movement of the chosen length, in a direction.
  step(x, y) {
    const [right, up] = turned([x, y]);
    this.link.send({ type: "step", direction: [right, up], mm: settings.step_mm });
  }
}

export function turned([x, y]) {
  return [settings.invert_x ? -x : x, settings.invert_y ? -y : y];
}

function shaped(stick) {
  return turned(stick).map((k) => Math.round(1000 * k * settings.sensitivity) / 1000);
}
