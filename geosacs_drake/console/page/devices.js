// The devices that the page sees: name, live axes, and how their controls are bound.

import { ASKED, Binding } from "./binding.js";
import { button, element } from "./elements.js";

export class Devices {
  constructor(root, dialog, gamepads, link) {
    this.root = root;
    this.dialog = dialog;
    this.gamepads = gamepads;
    this.link = link;
    this.binding = null;
    gamepads.addEventListener("devices", () => this.list());
    dialog.addEventListener("close", () => this.binding?.end(null));
    setInterval(() => this.live(), 100);
    this.list();
  }

  list() {
    this.bars = new Map();
    const rows = [...this.gamepads.seen].map(([number, known]) => {
      const name = element("span", "name", shortName(known.id));
      const bars = element("span", "bars");
      bars.setAttribute("aria-hidden", "true");
      bars.append(...known.axes.slice(0, 6).map(() => element("i")));
      this.bars.set(number, [...bars.children]);
      const bind = button("Set up", () => this.bind(known.id));
      bind.setAttribute("aria-label", `Set up ${shortName(known.id)}`);
      const row = element("li");
      row.append(name, bars, bind);
      return row;
    });
    if (!rows.length) rows.push(element("li", "none", "Mouse, touch and keys. A gamepad shows once a button of it is pressed."));
    this.root.replaceChildren(...rows);
  }

  live() {
    for (const [number, bars] of this.bars) {
      const known = this.gamepads.seen.get(number);
      bars.forEach((bar, i) => bar.style.setProperty("--at", `${50 + 50 * (known?.axes[i] ?? 0)}%`));
    }
  }

  bind(id) {
    const title = element("h2", "", `Set up ${shortName(id)}`);
    title.id = "binding-title";
    const words = element("p", "ask");
    words.setAttribute("role", "status");
    const row = element("div", "row");
    row.append(button("Leave out", () => this.binding?.skip()), button("Cancel", () => this.dialog.close()));
    this.dialog.replaceChildren(title, words, row);
    if (!this.dialog.open) this.dialog.showModal();
    this.binding = new Binding(
      this.gamepads,
      id,
      (what, k) => { words.textContent = `${k + 1} of ${ASKED.length}: move the control that shall ${what}, then let it go.`; },
      (bindings) => {
        this.binding = null;
        if (bindings) this.keep(id, bindings);
      },
    );
  }

  keep(id, bindings) {
    const label = element("label", "", "Keep it under the name");
    const input = element("input");
    input.value = shortName(id).replace(/[^\w .()+-]/g, "").slice(0, 40) || "controller";
    input.maxLength = 40;
    label.append(input);
    const row = element("div", "row");
    const save = button("Save", () => {
      this.gamepads.kept.set(id, bindings);
      this.link.send({ type: "bindings", name: input.value, bindings: { device: id.slice(0, 200), ...bindings } });
      this.dialog.close();
    });
    save.className = "main calls";
    row.append(save, button("Use it this time", () => {
      this.gamepads.kept.set(id, bindings);
      this.dialog.close();
    }));
    this.dialog.querySelector(".ask").textContent = "All controls are set.";
    this.dialog.querySelector(".row").replaceWith(label, row);
  }
}

function shortName(id) {
  return id.replace(/\s*\((?:STANDARD GAMEPAD )?\s*Vendor:.*\)$/i, "").trim() || "Gamepad";
}
