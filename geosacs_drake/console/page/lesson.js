// How a lesson stands: in words, and which buttons lead on.

import { element } from "./elements.js";

const byId = (id) => document.getElementById(id);

function put(id, text) {
  const part = byId(id);
  if (part.textContent !== text) part.textContent = text;
}

export function showLesson(status, you) {
  const others = status.holder !== "" && status.holder !== you;
  const saved = status.saved.length, kept = status.kept_s > 0;
  document.body.dataset.tone = status.tone;
  document.body.classList.toggle("recording", status.recording);
  document.body.classList.toggle("watching", others);
  put("headline", status.headline);
  put("sentence", others ? "Another page moves it. Stop works from here, too." : status.sentence);
  put("record", status.recording ? "Pause" : kept ? "Go on" : "Record");
  put("gripper", status.closed ? "Let go" : "Grip");
  put("f-kept", kept ? `${status.kept_s.toFixed(1)} s recorded` : "");
  put("f-place", `at ${status.tool.map((v) => (100 * v).toFixed(0)).join(", ")} cm`);
  put("f-link", status.delay_ms === null ? "" : `link ${Math.round(status.delay_ms)} ms`);
  byId("start").hidden = !status.stopped;
  enable("save", kept && !status.leads_back);
  enable("undo", status.way_back);
  enable("back", status.way_back && !status.leads_back);
  enable("discard", kept);
  enable("reset", !kept);
  enable("learn", saved >= 2 && !status.busy);
  enable("travel", status.learned && !status.busy);
  byId("record").classList.toggle("calls", !status.recording && !kept && saved < 2);
  byId("learn").classList.toggle("calls", saved >= 2 && !status.learned && !kept);
  byId("travel").classList.toggle("calls", status.learned);
  for (const name of ["learn", "travel"]) byId(name).classList.add("main");
  course("teach", saved >= 2, saved < 2);
  course("learn", status.learned, saved >= 2 && !status.learned);
  course("travel", false, status.learned);
  list(status.saved);
}

// A button that cannot do anything now; focus does not fall off it.
function enable(name, on) {
  const button = byId(name);
  if (button.disabled === on) button.disabled = !on;
}

function course(name, done, now) {
  const step = byId(`course-${name}`);
  step.classList.toggle("done", done);
  step.classList.toggle("now", now);
  if (now) step.setAttribute("aria-current", "step");
  else step.removeAttribute("aria-current");
}

let shown = "";
function list(saved) {
  const text = JSON.stringify(saved);
  if (text === shown) return;
  shown = text;
  const rows = saved.map(({ name, s }) => element("li", "", `${name}, ${Math.round(s)} s`));
  if (!rows.length) rows.push(element("li", "none", "None yet. Two make a canal."));
  byId("saved").replaceChildren(...rows);
}
