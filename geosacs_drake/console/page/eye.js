// The gripper's camera: a picture laid over the room, small or as large as the view; asked for one by one, as they are
// seen, so that nothing is rendered for nobody.

import { change, settings } from "./settings.js";

const SIZES = ["off", "inset", "large"];
const SAID = { off: "Gripper camera", inset: "Camera larger", large: "Camera off" };
const AGAIN_MS = 1000;

export class Eye extends EventTarget {
  constructor(link, button, figure) {
    super();
    this.link = link;
    this.button = button;
    this.figure = figure;
    this.picture = figure.querySelector("img");
    this.asked = 0;
    button.addEventListener("click", () => this.next());
    link.addEventListener("picture", ({ detail }) => this.show(detail));
    setInterval(() => { if (performance.now() - this.asked > AGAIN_MS) this.ask(); }, 250);
    this.name();
  }

  // Whether it is what the person looks at.
  get chosen() {
    return settings.eye === "large";
  }

  next() {
    change({ eye: SIZES[(SIZES.indexOf(settings.eye) + 1) % SIZES.length] });
    this.name();
    this.ask();
  }

  name() {
    this.button.textContent = SAID[settings.eye];
    this.button.setAttribute("aria-label", `${SAID[settings.eye]}: it is ${settings.eye === "inset" ? "small" : settings.eye}`);
    this.figure.hidden = settings.eye === "off";
    this.figure.classList.toggle("large", this.chosen);
  }

  ask() {
    if (settings.eye === "off" || document.hidden) return;
    this.asked = performance.now();
    this.link.send({ type: "look" });
  }

  show(data) {
    const before = this.picture.src;
    this.picture.onload = () => {
      if (before.startsWith("blob:")) URL.revokeObjectURL(before);
      this.figure.classList.add("sees");
      this.figure.dataset.pictures = Number(this.figure.dataset.pictures ?? 0) + 1;
      this.ask();
    };
    this.picture.src = URL.createObjectURL(new Blob([data], { type: "image/jpeg" }));
  }
}
