// "Move the control you want": each function in turn gets the control that moves furthest, then waits until it rests.

const FAR = 0.6, NEAR = 0.25;
export const ASKED = [
  ["right", "move right"], ["left", "move left"], ["up", "move up"], ["down", "move down"],
  ["gripper", "open and close the gripper"], ["reverse", "reverse"], ["start", "start and pause"], ["stop", "stop"],
];

export class Binding {
  // `show(words, done)` tells what to do; `finish(bindings)` gets them, or null.
  constructor(gamepads, id, show, finish) {
    this.gamepads = gamepads;
    this.id = id;
    this.show = show;
    this.finish = finish;
    this.bindings = {};
    this.place = 0;
    this.resting = false;
    gamepads.binding = (known) => { if (known.id === this.id) this.look(known); };
    this.ask();
  }

  ask() {
    this.resting = false;
    if (this.place >= ASKED.length) {
      this.end(this.bindings);
      return;
    }
    this.show(ASKED[this.place][1], this.place);
  }

  look(known) {
    const pushed = [
      ...known.axes.map((a, axis) => [Math.abs(a), { axis, sign: Math.sign(a) || 1 }]),
      ...known.buttons.map((b, button) => [b, { button }]),
    ].reduce((a, b) => (b[0] > a[0] ? b : a), [0, null]);
    if (!this.resting) {
      this.resting = pushed[0] < NEAR;
    } else if (pushed[0] > FAR) {
      this.bindings[ASKED[this.place][0]] = pushed[1];
      this.skip();
    }
  }

  skip() {
    this.place += 1;
    this.ask();
  }

  end(bindings) {
    this.gamepads.binding = null;
    this.finish(bindings);
  }
}
