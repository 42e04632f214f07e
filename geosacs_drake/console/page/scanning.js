// One switch or two: the parts of the page are lit in turn; a press chooses the one that is lit.

import { onChange, settings } from "./settings.js";
import { Ways, WAYS } from "./ways.js";

export class Scanning {
  constructor(stick, pad) {
    this.ways = new Ways(stick, "scanning");
    this.pad = pad;
    this.place = -1;
    this.timer = null;
    this.pressed = false;
    onChange(() => this.restart());
    document.addEventListener("pointerdown", (event) => this.pointer(event, true), true);
    document.addEventListener("pointerup", (event) => this.pointer(event, false), true);
    document.addEventListener("click", (event) => {
      if (this.on && event.detail > 0 && event.isTrusted && !isStop(event)) this.stop(event);
    }, true);
    this.restart();
  }

  get on() {
    return settings.scanning !== "off";
  }

  // What can be chosen now: in a dialog its choices and buttons, else the four directions and the page's buttons.
  get parts() {
    const dialog = document.querySelector("dialog[open]");
    if (dialog) return [...dialog.querySelectorAll(".options, button:not(.options button)")].filter(isShown);
    const buttons = [...document.querySelectorAll("main button")].filter(isShown);
    return [...Object.keys(WAYS), ...buttons];
  }

  restart() {
    clearInterval(this.timer);
    this.timer = null;
    this.light(-1);
    document.body.classList.toggle("scanning", this.on);
    if (settings.scanning === "one") {
      this.timer = setInterval(() => { if (!this.pressed) this.next(); }, 1000 * settings.dwell_s);
      this.next();
    } else if (this.on) {
      this.next();
    }
  }

  next() {
    this.light((this.place + 1) % this.parts.length);
  }

  light(place) {
    document.querySelectorAll(".lit").forEach((part) => part.classList.remove("lit"));
    delete this.pad.dataset.lit;
    this.place = place;
    this.part = this.parts[place];
    if (typeof this.part === "string") this.pad.dataset.lit = this.part;
    else this.part?.classList.add("lit");
    if (this.part instanceof Element) this.part.scrollIntoView({ block: "nearest" });
  }

  // A switch goes down or up: the one that chooses, or the one that goes on.
  turn(chooses, down) {
    this.pressed = down && chooses;
    if (!chooses) {
      if (down) this.next();
      return;
    }
    if (down && !this.parts.includes(this.part)) this.light(0);  // what was lit is gone
    if (typeof this.part === "string") {
      if (down) this.ways.push(this.part, WAYS[this.part]);
      else this.ways.release(this.part);
    } else if ("hold" in this.part.dataset) {
      this.part.dispatchEvent(new Event(down ? "hold" : "letgo"));
    } else if (down) {
      choose(this.part);
    }
  }

  // A key: whether it was a switch.
  key(event, down) {
    if (!this.on || !["Space", "Enter"].includes(event.code)) return false;
    if (!event.repeat) this.turn(settings.scanning === "one" || event.code === "Enter", down);
    return true;
  }

  // A button of a gamepad: with two switches, the first goes on.
  gamepad(name, down) {
    this.turn(settings.scanning === "one" || name !== "gripper", down);
  }

  pointer(event, down) {
    if (!this.on || !event.isTrusted || isStop(event)) return;
    this.stop(event);
    this.turn(true, down);
  }

  stop(event) {
    event.preventDefault();
    event.stopImmediatePropagation();
  }
}

// A choice goes on to its next option.
function choose(part) {
  if (!part.matches(".options")) {
    part.click();
    return;
  }
  const options = [...part.children];
  options[(options.findIndex((o) => o.getAttribute("aria-checked") === "true") + 1) % options.length].click();
}

// Stop is heard by whatever it is pressed.
function isStop(event) {
  return event.target.closest?.("#stop");
}

function isShown(part) {
  return part.offsetParent !== null && !part.disabled && part.ariaDisabled !== "true";
}
