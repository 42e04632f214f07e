// Keys: arrows or W A S D, two at once for diagonals; Space, R, Enter and Escape for the buttons.

import { Ways, WAYS } from "./ways.js";

const ARROWS = {
  ArrowRight: "right", KeyD: "right", ArrowLeft: "left", KeyA: "left",
  ArrowUp: "up", KeyW: "up", ArrowDown: "down", KeyS: "down",
};
const BUTTONS = { Space: "gripper", KeyG: "gripper", KeyR: "reverse", Enter: "start", Escape: "stop" };

export class Keys {
  // `taken` is asked first whether a key means something else.
  constructor(stick, press, taken) {
    this.stick = stick;
    this.press = press;
    this.taken = taken;
    this.ways = new Ways(stick, "keys");
    this.listeners = [
      ["keydown", (event) => this.down(event), true],
      ["keyup", (event) => this.up(event), true],
      ["blur", () => this.stick.centre(), false],
    ];
    this.listen(window);
  }

  // A frame that was clicked into gets the keys: they mean the same there. Listening twice is listening once.
  listen(target) {
    for (const listener of this.listeners) target.addEventListener(...listener);
  }

  down(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) {
      if (this.ways.held.size) this.stick.centre();
      return;
    }
    if (this.taken(event, true)) {
      event.preventDefault();
      event.stopPropagation();
      return;
    }
    if (document.querySelector("dialog[open]") || isTyping(event.target)) return;
    const way = ARROWS[event.code], button = BUTTONS[event.code];
    if (way) {
      event.preventDefault();
      if (!event.repeat) this.ways.push(event.code, WAYS[way]);
    } else if (button && !(isControl(event.target) && ["Space", "Enter"].includes(event.code))) {
      event.preventDefault();
      if (!event.repeat) this.press(button);
    }
  }

  up(event) {
    if (this.taken(event, false)) {
      event.preventDefault();
      event.stopPropagation();
    } else {
      this.ways.release(event.code);
    }
  }
}

function isTyping(target) {
  return target?.matches?.("input, select, textarea") ?? false;
}

function isControl(target) {
  return target?.matches?.("button, summary, a, [role=button]") ?? false;
}
