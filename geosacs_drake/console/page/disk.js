// The disk as the person sees it: its rim, the point on it, and the two axes that a correction follows.

const SIZE = 84;

// Where a person looks from, in the robot's base frame: which way is right, which is up.
const SEATS = {
  front: { right: [0, 1, 0], up: [0, 0, 1] },
  behind: { right: [0, -1, 0], up: [0, 0, 1] },
  left: { right: [-1, 0, 0], up: [0, 0, 1] },
  right: { right: [1, 0, 0], up: [0, 0, 1] },
};

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// A lying disk is looked at a little from above, or nothing of it were to be seen.
const TILT = 35 * Math.PI / 180;

function basis(seat) {
  const { right, up } = seat;
  const away = [up[1] * right[2] - up[2] * right[1], up[2] * right[0] - up[0] * right[2], up[0] * right[1] - up[1] * right[0]];
  const c = Math.cos(TILT), s = Math.sin(TILT);
  return { right, up: up.map((u, i) => c * u + s * away[i]) };
}

export class Disk {
  constructor(svg, words) {
    this.svg = svg;
    this.words = words;
    svg.innerHTML = `
      <circle class="floor" r="112"/>
      <path class="rim" id="disk-rim"/>
      <g id="disk-x" class="axis x"><line/><text>x</text></g>
      <g id="disk-y" class="axis y"><line/><text>y</text></g>
      <circle class="centre" r="2.500"/><line class="lead" id="disk-lead"/><circle class="point" id="disk-point" r="8"/>`;
    this.part = (id) => svg.querySelector(`#disk-${id}`);
  }

  show(status, camera, seat) {
    const view = camera ?? basis(SEATS[seat]);
    const [x, y] = status.axes.map((axis) => [SIZE * dot(axis, view.right), -SIZE * dot(axis, view.up)]);
    const at = (u, v) => [u * x[0] + v * y[0], u * x[1] + v * y[1]];
    const rim = Array.from({ length: 49 }, (_, k) => at(Math.cos(k * Math.PI / 24), Math.sin(k * Math.PI / 24)));
    this.part("rim").setAttribute("d", `M${rim.map((p) => p.map((v) => v.toFixed(1)).join(" ")).join("L")}z`);
    for (const [name, tip] of [["x", at(1.18, 0)], ["y", at(0, 1.18)]]) {
      const group = this.part(name), line = group.querySelector("line"), text = group.querySelector("text");
      line.setAttribute("x2", tip[0]);
      line.setAttribute("y2", tip[1]);
      text.setAttribute("x", tip[0] * 1.08);
      text.setAttribute("y", tip[1] * 1.08 + 4);
    }
    const point = at(status.eta * Math.cos(status.phi), status.eta * Math.sin(status.phi));
    this.part("lead").setAttribute("x2", point[0]);
    this.part("lead").setAttribute("y2", point[1]);
    this.part("point").setAttribute("cx", point[0]);
    this.part("point").setAttribute("cy", point[1]);
    this.svg.classList.toggle("steering", status.correcting);
    const off = Math.round(status.eta * status.radius_mm), wide = Math.round(status.radius_mm);
    this.words.textContent = `${off} mm off the middle of ${wide} mm`;
  }
}
