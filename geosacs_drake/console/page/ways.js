// Directions that are on or off, as keys, buttons and switches give them: while held, until pressed again, or in steps.
// A short press moves a little, a long one goes faster.

import { settings } from "./settings.js";

const TAP_MS = 150, FULL_MS = 400, TAP = 0.2;
const EVERY_MS = 25;

export const WAYS = { right: [1, 0], left: [-1, 0], up: [0, 1], down: [0, -1] };

export class Ways {
  constructor(stick, source) {
    this.stick = stick;
    this.source = source;
    this.held = new Map();
    this.since = 0;
    this.timer = null;
    stick.addEventListener("centre", () => this.letGo());
  }

  // Something named `id` begins to push in a way.
  push(id, way) {
    if (settings.mode === "step") {
      this.stick.step(...way);
      return;
    }
    if (settings.mode === "latch" && this.held.size) {
      const same = this.held.has(id);
      this.letGo();
      this.stick.hold(this.source, 0, 0);
      if (same) return;
    }
    if (!this.held.size) this.since = performance.now();
    this.held.set(id, way);
    this.timer ??= setInterval(() => this.tell(), EVERY_MS);
    this.tell();
  }

  // It ends; latched, it goes on.
  release(id) {
    if (settings.mode === "latch" || !this.held.delete(id)) return;
    this.tell();
    if (!this.held.size) this.letGo();
  }

  letGo() {
    this.held.clear();
    clearInterval(this.timer);
    this.timer = null;
  }

  tell() {
    if (this.stick.wake()) return;
    let x = 0, y = 0;
    for (const way of this.held.values()) {
      x += way[0];
      y += way[1];
    }
    [x, y] = [Math.sign(x), Math.sign(y)];
    const long = Math.hypot(x, y), ms = performance.now() - this.since;
    const k = long ? Math.min(1, TAP + (1 - TAP) * Math.max(0, ms - TAP_MS) / (FULL_MS - TAP_MS)) / long : 0;
    this.stick.hold(this.source, k * x, k * y);
  }
}
