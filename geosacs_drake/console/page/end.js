// What was achieved.

const time = (seconds) => `${Math.floor(seconds / 60)}:${String(Math.round(seconds % 60)).padStart(2, "0")} min`;

function row(term, text) {
  const line = document.createElement("div");
  const dt = document.createElement("dt"), dd = document.createElement("dd");
  dt.textContent = term;
  dd.textContent = text;
  line.append(dt, dd);
  return line;
}

export function showEnd(summary, link) {
  const card = document.getElementById("end");
  const title = document.createElement("h2");
  title.id = "end-title";
  title.textContent = summary.success ? "Done" : "Ended";
  const why = document.createElement("p");
  why.textContent = sentence(summary.reason ?? "");
  const list = document.createElement("dl");
  const items = summary.items ?? [];
  if (items.length) {
    list.append(
      row("Placed", `${items.filter((item) => item.placed).length} of ${items.length}`),
      row("Task time", time(summary.task_time_s)),
      row("Steering", `${Math.round(100 * summary.correction_share)} % of it, ${summary.corrections} times`),
      row("Moved by the stick", `${summary.correction_distance_m.toFixed(2)} m`),
      row("Reversals", String(summary.backtracks)),
      row("Hardest contact", force(summary.max_contact_force_n)),
    );
  }
  const buttons = document.createElement("div");
  buttons.className = "row";
  const close = document.createElement("button");
  close.textContent = "Close";
  close.addEventListener("click", () => {
    link.send({ type: "leave" });
    card.close();
  });
  if (summary.again) {
    const again = document.createElement("button");
    again.className = "main calls";
    again.textContent = "Run again";
    again.addEventListener("click", () => {
      link.send({ type: "again" });
      card.close();
    });
    buttons.append(again);
  }
  buttons.append(close);
  card.replaceChildren(title, why, list, buttons);
  if (!card.open) card.showModal();
}

function sentence(text) {
  return text ? `${text[0].toUpperCase()}${text.slice(1)}.` : "";
}

function force(pairs = {}) {
  const [pair, most] = Object.entries(pairs).reduce((a, b) => (b[1] > a[1] ? b : a), ["", 0]);
  return most > 1 ? `${Math.round(most)} N, ${pair.split("-")[1]}` : "none";
}
