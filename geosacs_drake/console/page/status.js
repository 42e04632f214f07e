// The status in words and figures.

const byId = (id) => document.getElementById(id);

function put(id, text) {
  const element = byId(id);
  if (element.textContent !== text) element.textContent = text;
}

function clock(seconds) {
  const whole = Math.floor(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

export function showStatus(status, you) {
  document.body.dataset.tone = status.tone;
  put("headline", status.headline);
  put("sentence", status.sentence);
  put("leg", status.begun ? `${status.leg}, ${Math.round(100 * status.progress)} % of the way` : "");
  showTrack(status);
  const share = status.task_s > 0 ? 100 * status.correction_s / status.task_s : 0;
  put("f-time", clock(status.task_s));
  put("f-share", `${status.correction_s.toFixed(1)} s, ${share.toFixed(0)} %`);
  put("f-gripper", status.closed ? "closed" : "open");
  put("f-placed", `${status.items.filter((item) => item.placed).length} of ${status.items.length}`);
  put("f-rate", status.rate === null || !status.begun ? "–" : `${status.rate.toFixed(2)}×`);
  put("f-delay", status.delay_ms === null ? "–" : `${Math.round(status.delay_ms)} ms`);
  showButtons(status, you);
}

function showTrack(status) {
  const here = 50 + 50 * status.phase;
  byId("track-here").style.left = `${here}%`;
  byId("track-done").style.left = `${Math.min(here, 50)}%`;
  byId("track-done").style.width = `${Math.abs(here - 50)}%`;
  const track = byId("track"), percent = String(Math.round(100 * status.progress));
  if (track.getAttribute("aria-valuenow") !== percent) {
    track.setAttribute("aria-valuenow", percent);
    track.setAttribute("aria-valuetext", `${status.leg}, ${percent} percent`);
  }
}

function showButtons(status, you) {
  const mine = status.holder === you;
  const others = status.holder !== "" && !mine;
  put("start", status.start || "Waiting");
  byId("start").setAttribute("aria-disabled", String(!status.start));  // a press is still heard: it is told why
  put("gripper", status.closed ? "Let go" : "Grip");
  put("take", others ? "Take control" : !status.begun ? "Watch" : status.person ? "Hand back" : "Take control");
  document.body.classList.toggle("watching", others);
  byId("take").title = others ? "Another page is in control" : "";
  byId("start").classList.toggle("calls", !status.running);
}

export function showEvent(event) {
  const item = document.createElement("li");
  item.dataset.kind = event.kind ?? "";
  const when = document.createElement("time");
  when.textContent = clock(event.time_s);
  item.append(when, event.text);
  const list = byId("history");
  list.prepend(item);
  while (list.children.length > 40) list.lastChild.remove();
}

export function clearHistory() {
  byId("history").replaceChildren();
}
