// What a person can choose: buttons throughout, so that one switch reaches all of it.

import { button, element } from "./elements.js";
import { change, settings } from "./settings.js";

const CHOICES = [
  ["mode", "The stick moves", [["held", "while held"], ["latch", "until pressed again"], ["step", "in steps"]]],
  ["step_mm", "A step is", [[2, "2 mm"], [5, "5 mm"], [10, "10 mm"], [20, "20 mm"]]],
  ["sensitivity", "A full push is", [[0.3, "slow"], [0.6, "medium"], [1, "full speed"]]],
  ["mapping", "Right and up are", [["seat", "as I sit"], ["view", "as in the picture"], ["axes", "the canal's axes"]]],
  ["seat", "I sit", [["front", "facing the robot"], ["left", "at its left"], ["right", "at its right"], ["behind", "behind it"]]],
  ["dead_zone", "A stick rests within", [[0.06, "6 %"], [0.12, "12 %"], [0.25, "25 %"]]],
  ["invert_x", "Right and left", [[false, "as they are"], [true, "swapped"]]],
  ["invert_y", "Up and down", [[false, "as they are"], [true, "swapped"]]],
  ["scanning", "Switches", [["off", "none"], ["one", "one"], ["two", "two"]]],
  ["dwell_s", "One switch waits", [[0.8, "0.8 s"], [1.5, "1.5 s"], [2.5, "2.5 s"], [4, "4 s"]]],
];

// `keys` are the ones that this page has a use for; all where it does not say.
export function openSettings(dialog, keys = CHOICES.map(([key]) => key)) {
  const title = element("h2", "", "Settings");
  title.id = "settings-title";
  const rows = CHOICES.filter(([key]) => keys.includes(key)).map(([key, words, options]) => group(key, words, options));
  const note = element("p", "note", "With one switch, the parts of the page are lit in turn: press Space, Enter, a button of a gamepad "
    + "or anywhere to choose. With two, Space goes on and Enter chooses.");
  const close = button("Done", () => dialog.close());
  close.className = "main calls wide";
  dialog.replaceChildren(title, ...rows, note, close);
  if (!dialog.open) dialog.showModal();
}

function group(key, words, options) {
  const row = element("div", "choice");
  const label = element("span", "", words);
  label.id = `choice-${key}`;
  const buttons = element("div", "options");
  buttons.setAttribute("role", "radiogroup");
  buttons.setAttribute("aria-labelledby", label.id);
  for (const [value, text] of options) {
    const option = button(text, () => {
      change({ [key]: value });
      for (const other of buttons.children) other.setAttribute("aria-checked", String(other === option));
    });
    option.setAttribute("role", "radio");
    option.setAttribute("aria-checked", String(settings[key] === value));
    buttons.append(option);
  }
  row.append(label, buttons);
  return row;
}
