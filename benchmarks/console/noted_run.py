"""A run with its console that notes when what happened, for `bench_console`.

python -m benchmarks.console.noted_run NOTES.json TASK [OPTIONS]
"""

from __future__ import annotations

import atexit
import functools
import json
import os
import sys
import time
from pathlib import Path

import numpy as np

from geosacs_drake.console.control import Control
from geosacs_drake.console.handlers import MeshcatSocket
from geosacs_drake.console.status import StatusReporter
from geosacs_drake.run import main

MOVED = 2e-4
"""[m] Of the tool, after which the robot moves."""


def note_all(notes: dict[str, list]) -> None:
    """Note, by the clock on the wall [s], commands, samples, movements of the tool and pictures sent."""
    drive, sample, look, pass_on = Control.drive, Control.sample, StatusReporter.__call__, MeshcatSocket._pass_on
    last = {"stick": None, "sample": None, "p": np.zeros(3), "sent": 0}

    @functools.wraps(drive)
    def noted_drive(self, page, stick, age_s=0.0):
        if stick != last["stick"]:
            notes["command"].append((time.time(), bool(any(stick))))
            last["stick"] = stick
        return drive(self, page, stick, age_s)

    @functools.wraps(sample)
    def noted_sample(self):
        taken = sample(self)
        pushed = bool(taken.joystick[:2].any())
        if pushed != last["sample"]:
            notes["sample"].append((time.time(), pushed))
            last["sample"] = pushed
        return taken

    def noted_look(self, root):
        station = self._system.station
        p = station.GetOutputPort("X_BT").Eval(station.GetMyContextFromRoot(root))[:3]
        if np.linalg.norm(p - last["p"]) > MOVED:
            notes["moved"].append((time.time(), True))
            last["p"] = p.copy()
        look(self, root)

    def noted_pass_on(self):
        before = self.sent
        pass_on(self)
        if self.sent != before:
            notes["sent"].append((time.time(), self.sent))

    Control.drive, Control.sample = noted_drive, noted_sample  # type: ignore[method-assign]
    StatusReporter.__call__, MeshcatSocket._pass_on = noted_look, noted_pass_on  # type: ignore[method-assign]


if __name__ == "__main__":
    notes: dict[str, list] = {name: [] for name in ("command", "sample", "moved", "sent")}
    note_all(notes)
    leave = os._exit

    def write_and_leave(status: int) -> None:
        Path(sys.argv[1]).write_text(json.dumps(notes))
        leave(status)

    os._exit = write_and_leave  # type: ignore[assignment]
    atexit.register(lambda: Path(sys.argv[1]).write_text(json.dumps(notes)))
    main(sys.argv[2], sys.argv[3:])
