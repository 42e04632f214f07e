// What a person has chosen, kept in this browser.

const KEY = "geosacs-console";

export const DEFAULTS = {
  mode: "held",         // held, latch, step
  step_mm: 5,
  sensitivity: 1,
  dead_zone: 0.12,
  invert_x: false,
  invert_y: false,
  mapping: "view",      // axes, seat, view
  seat: "front",        // front, left, right, behind
  scanning: "off",      // off, one, two
  dwell_s: 1.5,
  view: "room",         // see camera.js
  eye: "off",           // off, inset, large: the gripper's camera
};

export const settings = { ...DEFAULTS, ...stored() };
const listeners = new Set();

// What the run was started with, unless the person has chosen something else here before.
export function suggest(changes) {
  const kept = stored();
  for (const [key, value] of Object.entries(changes)) if (value !== undefined && !(key in kept)) settings[key] = value;
}

export function change(changes) {
  Object.assign(settings, changes);
  try { localStorage.setItem(KEY, JSON.stringify({ ...stored(), ...changes })); } catch { /* it lasts as long as the page, then */ }
  for (const listener of listeners) listener(settings);
}

export function onChange(listener) {
  listeners.add(listener);
}

function stored() {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? "{}");
    return Object.fromEntries(Object.entries(kept).filter(([k, v]) => k in DEFAULTS && typeof v === typeof DEFAULTS[k]));
  } catch {
    return {};
  }
}
