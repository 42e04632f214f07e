"""How late the console's link and picture are, in a Chromium that draws in software.

    make bench-console

A person holds an arrow key for a moment and lets it go, again and again; then the page is closed in mid-push.
Another page, of a server without a robot, is hidden, frozen, stopped, closed and killed in mid-push. Times are those of
one machine's clock, of the page's events and of the run.
"""

from __future__ import annotations

import argparse
import bisect
import itertools
import json
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.console.attacked_run import attacked
from benchmarks.console.let_go import all_ways
from benchmarks.console.own_browser import ARGS
from benchmarks.table import Row, print_table, write_csv

OUTPUT = Path(__file__).parents[1] / "build" / "bench-console.csv"
WATCH = """() => {
    const now = () => (performance.timeOrigin + performance.now()) / 1000;
    window.noted = {down: [], up: [], steering: [], drawn: []};
    addEventListener("keydown", (e) => noted.down.push((performance.timeOrigin + e.timeStamp) / 1000), true);
    addEventListener("keyup", (e) => noted.up.push((performance.timeOrigin + e.timeStamp) / 1000), true);
    addEventListener("message", (e) => { if (e.data.drawn) noted.drawn.push([now(), e.data.drawn]); });
    let was = "";
    new MutationObserver(() => {
        const text = document.getElementById("headline").textContent;
        if (text !== was && text === "Steering") noted.steering.push(now());
        was = text;
    }).observe(document.getElementById("headline"), {childList: true, characterData: true, subtree: true});
}"""


def after(times: list[float], moment: float) -> float:
    """How long after a moment the next of `times` (ascending) comes [ms]."""
    k = bisect.bisect_left(times, moment)
    return 1000 * (times[k] - moment) if k < len(times) else np.nan


def lags(sent: dict[int, float], drawn: list[tuple[float, int]]) -> np.ndarray:
    """How far behind the picture is just before each next one is drawn: since what it does not show was there [ms]."""
    behind = []
    for (_, number), (then, _) in itertools.pairwise(drawn):
        if number + 1 in sent:
            behind.append(1000 * (then - sent[number + 1]))
    return np.array(behind)


def measure(presses: int, arguments: list[str]) -> dict[str, np.ndarray]:
    """Run laundry, press, and collect what was noted."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder:
        notes = Path(folder) / "notes.json"
        command = [
            sys.executable,
            "-u",
            "-m",
            "benchmarks.console.noted_run",
            str(notes),
            "laundry",
            "--port",
            "0",
            *arguments,
        ]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        assert run.stdout is not None
        address = next(m.group(1) for line in run.stdout if (m := re.search(r"at (http://\S+)", line)))
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(
                executable_path=shutil.which("chromium") or playwright.chromium.executable_path, args=list(ARGS)
            )
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(address)
            page.get_by_role("button", name="Start", exact=True).click()
            page.wait_for_timeout(8000)
            page.evaluate(WATCH)
            for k in range(presses):
                key = ("ArrowRight", "ArrowUp", "ArrowLeft", "ArrowDown")[k % 4]
                page.keyboard.down(key)
                page.wait_for_timeout(350 + 37 * (k % 5))
                page.keyboard.up(key)
                page.wait_for_timeout(350 + 29 * (k % 7))
            seen = page.evaluate("noted")
            rate = page.inner_text("#f-rate").rstrip("×")
            page.keyboard.down("ArrowRight")
            page.wait_for_timeout(600)
            closing = time.time()
            page.close()
            time.sleep(0.6)
            page = browser.new_page()
            page.goto(address)
            page.wait_for_timeout(2000)
            run.send_signal(signal.SIGINT)
            asked = time.monotonic()
            run.wait()
            gone = 1000 * (time.monotonic() - asked)
            browser.close()
        noted = json.loads(notes.read_text())
    times = {
        (name, on): [t for t, v in noted[name] if v is on] for name in ("command", "sample") for on in (True, False)
    }
    moved = [t for t, _ in noted["moved"]]
    sent = {int(number): t for t, number in noted["sent"]}
    return {
        "event to Python": np.array([after(times["command", True], t) for t in seen["down"]]),
        "press to sample": np.array([after(times["sample", True], t) for t in seen["down"]]),
        "press to robot moving": np.array([after(moved, t) for t in seen["down"]]),
        "release to stick at zero": np.array([after(times["sample", False], t) for t in seen["up"]]),
        "sample to status in page": np.array(
            [after(seen["steering"], t) for t in times["sample", True]][: len(seen["steering"])]
        ),
        "picture behind": lags(sent, [(t, n) for t, n in seen["drawn"]]),
        "tab closed to stick at zero": np.array([after(times["sample", False], closing)]),
        "Ctrl-C with a tab open to gone": np.array([gone]),
        "real-time factor": np.array([float(rate)]),
    }


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--presses", type=int, default=40)
    parser.add_argument("--attack", type=float, default=60.0, help="seconds of an attack from outside")
    parser.add_argument("--repeats", type=int, default=5, help="of each way in which a page goes")
    parser.add_argument("--items", default="soft")
    options = parser.parse_args()
    rows = []
    measured = measure(options.presses, ["--items", options.items])
    measured |= {f"{words} to stick at zero": times for words, times in all_ways(options.repeats).items()}
    for name, values in measured.items():
        unit = "1" if name == "real-time factor" else "ms"
        values = values[np.isfinite(values)]
        shown = {"p50": 50, "p95": 95, "max": 100} if len(values) > 1 else {"value": 50}
        rows += [
            Row("console", name, k, float(np.percentile(values, q)), unit) for k, q in shown.items() if len(values)
        ]
    for name, value in attacked(options.attack).items():
        rows.append(Row("console, attacked", name, "value", value, "mm" if name == "moved" else "1"))
    print_table(rows)
    write_csv(OUTPUT, rows)


if __name__ == "__main__":
    main()
