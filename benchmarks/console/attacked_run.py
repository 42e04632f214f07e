"""A run that is attacked from outside: what is let in, and whether the robot moves."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.acceptance.commands import empty_folder, log_of
from benchmarks.canal_quality import ROOT
from benchmarks.console.attack import Attack
from benchmarks.console.raw_client import linked, say
from canal.navigation.joystick import START

STARTED_S = 3.0
"""[s] That the robot travels, before it is paused and attacked."""


def attacked(seconds: float) -> dict[str, float]:
    """A run, started and paused by an honest page that leaves, and attacked for so long or until all was tried."""
    with empty_folder() as folder:
        log, summary = folder / "log.npz", folder / "summary.json"
        with _Run(folder, "--log", str(log), "--summary", str(summary)) as (process, port, token):
            with linked(port, token) as page:
                say(page, 0, t=1000 * time.monotonic(), type="press", button="start")
                time.sleep(STARTED_S)
                say(page, 1, t=1000 * time.monotonic(), type="press", button="start")
                time.sleep(1.0)
            attack = Attack(port, token)
            attack.run(seconds)
            process.send_signal(signal.SIGINT)
            status = process.wait(60)
        print(attack.tried, attack.let_in[:20])
        signals = log_of(log) if log.exists() else {}
        figures: dict[str, float] = {"let in": float(len(attack.let_in)), "tried": float(sum(attack.tried.values()))}
        if signals and summary.exists() and status == 1:
            pressed = np.flatnonzero(np.diff(signals["joystick"][:, START], prepend=0.0) > 0)
            print("Start was pressed at", signals["joystick_time"][pressed])
            if len(pressed) == 2:  # and no third one
                paused = signals["joystick_time"][pressed[1]] + 1.0
                tool = signals["X_BT_desired"][signals["time"] > paused, :3]
                stick = signals["joystick"][signals["joystick_time"] > paused]
                figures |= {
                    "moved": 1000 * float(np.ptp(tool, axis=0).max()),
                    "samples": float(np.any(stick != 0, axis=1).sum()),
                    "goes on [s]": float(signals["time"][-1] - paused),
                }
    return figures


class _Run:
    """A laundry with its console, for a `with` block: its process, port and token."""

    def __init__(self, folder: Path, *options: str) -> None:
        command = [sys.executable, "-u", "-m", "geosacs_drake.run_laundry", "--items", "rigid", "--operator", "person"]
        self._command = [*command, "--port", "0", *options]
        self._printed = folder / "printed.txt"

    def __enter__(self) -> tuple[subprocess.Popen[bytes], int, str]:
        with self._printed.open("wb") as printed:
            self._process = subprocess.Popen(self._command, cwd=ROOT, stdout=printed, stderr=subprocess.STDOUT)
        while not (found := re.search(r"at http://localhost:(\d+)/([\w-]+)/\s", self._printed.read_text())):
            if self._process.poll() is not None:
                raise RuntimeError(self._printed.read_text())
            time.sleep(0.1)
        return self._process, int(found.group(1)), found.group(2)

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()
        print(self._printed.read_text())
