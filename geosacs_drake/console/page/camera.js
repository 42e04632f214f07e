// Where one looks from, and which way is right and up there, in the robot's base frame.

import { change, settings } from "./settings.js";

// Eye and target in the base frame [m]; null follows the gripper.
const VIEWS = {
  room: { name: "From the room", eye: [1.95, -0.95, 1.55], target: [0.17, 0.27, 0.56] },
  seat: { name: "From the seat" },
  shoulder: { name: "Over the shoulder", eye: [-1.05, -0.75, 1.75], target: [0.25, 0.3, 0.5] },
  above: { name: "From above", eye: [0.25, 0.2, 2.75], target: [0.2, 0.21, 0.4] },
  gripper: { name: "From the gripper", follow: true },
};
const SEAT_EYES = { front: [2.3, 0.25, 1.3], left: [0.2, 2.5, 1.3], right: [0.2, -2.0, 1.3], behind: [-1.7, 0.2, 1.45] };
const MIDDLE = [0.15, 0.27, 0.56];

export class Camera extends EventTarget {
  constructor(frame, button) {
    super();
    this.frame = frame;
    this.button = button;
    this.yaw = 0;
    this.position = [0, 0, 0];
    this.basis = null;
    button.addEventListener("click", () => this.next());
    window.addEventListener("message", (event) => this.hear(event));
    this.name();
  }

  next() {
    const names = Object.keys(VIEWS);
    change({ view: names[(names.indexOf(settings.view) + 1) % names.length] });
    this.name();
    this.look();
  }

  name() {
    this.button.textContent = VIEWS[settings.view].name;
    this.button.setAttribute("aria-label", `View: ${VIEWS[settings.view].name.toLowerCase()}. Change`);
  }

  look() {
    const view = VIEWS[settings.view];
    const eye = settings.view === "seat" ? SEAT_EYES[settings.seat] : view.eye;
    const target = view.target ?? MIDDLE;
    this.frame.contentWindow?.lookFrom?.(
      view.follow ? { follow: true } : { eye: this.toWorld(eye), target: this.toWorld(target) });
  }

  toWorld([x, y, z]) {
    const c = Math.cos(this.yaw), s = Math.sin(this.yaw), [px, py, pz] = this.position;
    return [c * x - s * y + px, s * x + c * y + py, z + pz];
  }

  hear({ origin, source, data }) {
    if (origin !== location.origin || source !== this.frame.contentWindow) return;
    if (data.ready) this.look();
    if (!data.right) return;
    const c = Math.cos(this.yaw), s = Math.sin(this.yaw);
    const toBase = ([x, y, z]) => [c * x + s * y, -s * x + c * y, z];
    this.basis = { right: toBase(data.right), up: toBase(data.up) };
    this.dispatchEvent(new Event("turned"));
  }
}
