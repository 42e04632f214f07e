// Keys: arrows or W A S D while held, two at once for diagonals; a short tap moves a little, a held key goes faster.

import { settings } from "./settings.js";

const WAYS = {
  ArrowRight: [1, 0], KeyD: [1, 0], ArrowLeft: [-1, 0], KeyA: [-1, 0],
  ArrowUp: [0, 1], KeyW: [0, 1], ArrowDown: [0, -1], KeyS: [0, -1],
};
const BUTTONS = { Space: "gripper", KeyG: "gripper", KeyR: "reverse", Enter: "start", Escape: "stop" };
const TAP_MS = 150, FULL_MS = 400, TAP = 0.2;
const EVERY_MS = 25;

export class Keys {
  constructor(stick, press) {
    this.stick = stick;
    this.press = press;
    this.held = new Set();
    this.since = 0;
    this.timer = null;
    this.listen(window);
    stick.addEventListener("centre", () => this.letGo());
  }

  // A frame that was clicked into gets the keys: they mean the same there.
  listen(target) {
    target.addEventListener("keydown", (event) => this.down(event), true);
    target.addEventListener("keyup", (event) => this.up(event), true);
    target.addEventListener("blur", () => this.stick.centre());
  }

  down(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) {
      if (this.held.size) this.stick.centre();
      return;
    }
    if (document.querySelector("dialog[open]") || isTyping(event.target)) return;
    const way = WAYS[event.code], button = BUTTONS[event.code];
    if (way) {
      event.preventDefault();
      if (!event.repeat) this.push(event.code, way);
    } else if (button && !(isControl(event.target) && ["Space", "Enter"].includes(event.code))) {
      event.preventDefault();
      if (!event.repeat) this.press(button);
    }
  }

  push(code, way) {
    if (settings.mode === "step") {
      this.stick.step(...way);
      return;
    }
    if (settings.mode === "latch" && this.held.size) {
      const same = this.held.has(code);
      this.letGo();
      this.stick.hold("keys", 0, 0);
      if (same) return;
    }
    if (!this.held.size) this.since = performance.now();
    this.held.add(code);
    this.timer ??= setInterval(() => this.tell(), EVERY_MS);
    this.tell();
  }

  up(event) {
    if (settings.mode === "latch" || !this.held.delete(event.code)) return;
    this.tell();
    if (!this.held.size) this.letGo();
  }

  letGo() {
    this.held.clear();
    clearInterval(this.timer);
    this.timer = null;
  }

  tell() {
    let x = 0, y = 0;
    for (const code of this.held) {
      x += WAYS[code][0];
      y += WAYS[code][1];
    }
    [x, y] = [Math.sign(x), Math.sign(y)];
    const long = Math.hypot(x, y);
    const ms = performance.now() - this.since;
    const k = long ? Math.min(1, TAP + (1 - TAP) * Math.max(0, ms - TAP_MS) / (FULL_MS - TAP_MS)) / long : 0;
    this.stick.hold("keys", k * x, k * y);
  }
}

function isTyping(target) {
  return target instanceof Element && target.matches("input, select, textarea");
}

function isControl(target) {
  return target instanceof Element && target.matches("button, summary, a, [role=button]");
}
