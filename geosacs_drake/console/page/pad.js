// The round pad: mouse, touch or pen. Fine near its middle.

import { settings } from "./settings.js";

const CURVE = 1.6;
const KNOB_WAY = 62;  // of the 100 units to the rim

export class Pad {
  constructor(element, knob, stick) {
    this.element = element;
    this.knob = knob;
    this.stick = stick;
    this.pointer = null;
    element.addEventListener("pointerdown", (event) => this.begin(event));
    element.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"])
      element.addEventListener(name, (event) => this.end(event));
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    stick.addEventListener("change", () => this.show());
    stick.addEventListener("centre", () => { this.pointer = null; this.show(); });
  }

  begin(event) {
    if (this.pointer !== null || (event.pointerType === "mouse" && event.button !== 0)) return;
    event.preventDefault();
    this.element.focus({ focusVisible: false });
    const [x, y] = this.place(event);
    if (settings.mode === "step") {
      if (x || y) this.stick.step(...direction(x, y));
      return;
    }
    if (settings.mode === "latch" && this.stick.active === "pad") {
      this.stick.hold("pad", 0, 0);
      return;
    }
    this.pointer = event.pointerId;
    this.element.setPointerCapture(event.pointerId);
    this.stick.hold("pad", x, y);
  }

  move(event) {
    if (event.pointerId === this.pointer) this.stick.hold("pad", ...this.place(event));
  }

  end(event) {
    if (event.pointerId !== this.pointer) return;
    this.pointer = null;
    if (settings.mode !== "latch") this.stick.hold("pad", 0, 0);
  }

  // Right and up in the unit disc.
  place(event) {
    const box = this.element.getBoundingClientRect();
    const half = box.width / 2;
    const x = (event.clientX - box.left - half) / half / (KNOB_WAY / 100);
    const y = -(event.clientY - box.top - half) / half / (KNOB_WAY / 100);
    const far = Math.hypot(x, y);
    if (far <= settings.dead_zone) return [0, 0];
    const k = Math.min((Math.min(far, 1) - settings.dead_zone) / (1 - settings.dead_zone), 1) ** CURVE / far;
    return [x * k, y * k];
  }

  show() {
    const [x, y] = this.stick.value;
    const long = Math.hypot(x, y);
    const k = long ? long ** (1 / CURVE) / long : 0;
    this.knob.setAttribute("transform", `translate(${x * k * KNOB_WAY} ${-y * k * KNOB_WAY})`);
    this.element.classList.toggle("pushed", long > 0);
  }
}

function direction(x, y) {
  const long = Math.hypot(x, y);
  return [x / long, y / long];
}
