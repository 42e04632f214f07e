// Gamepads, joysticks, adaptive controllers: each one by its own bindings, where it rests and what it is called.

import { settings } from "./settings.js";
import { Ways, WAYS } from "./ways.js";

const EVERY_MS = 16;
const ON = 0.5;            // of a button or an axis that is used as one
const STRAY = 0.4;         // a stick rests nearer to its centre than this
const CURVE = 1.5;
const BUTTONS = ["gripper", "reverse", "start", "stop"];
const MORE = ["lower", "raise", "mode"];

// Of the browsers' standard layout, and a fair guess for the others.
export const STANDARD = {
  right: { axis: 0, sign: 1 }, left: { axis: 0, sign: -1 }, up: { axis: 1, sign: -1 }, down: { axis: 1, sign: 1 },
  gripper: { button: 0 }, reverse: { button: 1 }, start: { button: 9 }, stop: { button: 8 },
  lower: { button: 4 }, raise: { button: 5 }, mode: { button: 3 },
};
const CROSS = { up: 12, down: 13, left: 14, right: 15 };

export class Gamepads extends EventTarget {
  constructor(stick, press, kept) {
    super();
    this.stick = stick;
    this.press = press;
    this.kept = kept;         // bindings by the device's name
    this.seen = new Map();    // what is known of each, by its number
    this.binding = null;      // gets all readings while controls are bound
    this.more = null;         // gets what else a page has buttons for
    this.switched = null;     // gets presses while switches are scanned
    setInterval(() => this.poll(), EVERY_MS);
    stick.addEventListener("centre", () => { for (const pad of this.seen.values()) pad.quiet = true; });
  }

  poll() {
    if (document.hidden || !document.hasFocus()) return;
    const pads = [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad?.connected);
    let changed = false;
    for (const [number, known] of this.seen) {
      if (pads.some((pad) => pad.index === number && pad.id === known.id)) continue;
      this.stick.hold(`pad ${number}`, 0, 0);
      this.stick.hold(`cross ${number}`, 0, 0);
      this.seen.delete(number);
      changed = true;
    }
    for (const pad of pads) {
      let known = this.seen.get(pad.index);
      if (!known) {
        const rest = pad.axes.map((a) => (Math.abs(a) < STRAY || Math.abs(a) > 0.9 ? a : 0));
        known = { id: pad.id, rest, down: new Set(), ways: new Ways(this.stick, `cross ${pad.index}`), quiet: false };
        this.seen.set(pad.index, known);
        changed = true;
      }
      known.axes = pad.axes.map((a, i) => offRest(a, known.rest[i] ?? 0));
      known.buttons = pad.buttons.map((b) => b.value);
      if (this.binding) this.binding(known);
      else this.read(pad, known);
    }
    if (changed) this.dispatchEvent(new Event("devices"));
  }

  read(pad, known) {
    const bindings = this.kept.get(pad.id) ?? STANDARD;
    for (const name of BUTTONS) this.edge(known, name, value(known, bindings[name]) > ON);
    if (this.more) for (const name of MORE) this.edge(known, name, value(known, bindings[name]) > ON);
    const pushed = { x: part(known, bindings.right, bindings.left), y: part(known, bindings.up, bindings.down) };
    const crossed = (name) => bindings === STANDARD && pad.mapping === "standard" && (known.buttons[CROSS[name]] ?? 0) > ON;
    const digital = settings.mode !== "held" || !("axis" in (bindings.right ?? bindings.up ?? {}));
    if (digital) {
      for (const name of Object.keys(WAYS)) this.way(known, name, value(known, bindings[name]) > ON || crossed(name));
    } else {
      this.hold(pad.index, known, pushed);
      for (const name of Object.keys(CROSS)) this.way(known, name, crossed(name));
    }
  }

  hold(number, known, { x, y }) {
    const far = Math.hypot(x, y);
    if (far <= settings.dead_zone) {
      known.quiet = false;  // after everything fell to its centre, a stick counts once it was there itself
      this.stick.hold(`pad ${number}`, 0, 0);
    } else if (!known.quiet) {
      const k = Math.min((Math.min(far, 1) - settings.dead_zone) / (1 - settings.dead_zone), 1) ** CURVE / far;
      this.stick.hold(`pad ${number}`, x * k, y * k);
    }
  }

  edge(known, name, on) {
    if (on === known.down.has(name)) return;
    if (on) known.down.add(name);
    else known.down.delete(name);
    if (this.switched) this.switched(name, on);
    else if (MORE.includes(name)) this.more(name, on);
    else if (on) this.press(name);
  }

  way(known, name, on) {
    const key = `way ${name}`;
    if (on === known.down.has(key)) return;
    if (on) {
      known.down.add(key);
      known.ways.push(name, WAYS[name]);
    } else {
      known.down.delete(key);
      known.ways.release(name);
    }
  }
}

function offRest(axis, rest) {
  const off = axis - rest;
  const way = off >= 0 ? 1 - rest : 1 + rest;
  return way > 0.01 ? Math.max(-1, Math.min(1, off / way)) : 0;
}

// How far a bound control is pushed, 0 to 1.
export function value(known, bound) {
  if (!bound) return 0;
  if ("button" in bound) return known.buttons[bound.button] ?? 0;
  return Math.max(0, bound.sign * (known.axes[bound.axis] ?? 0));
}

function part(known, one, other) {
  return value(known, one) - value(known, other);
}
