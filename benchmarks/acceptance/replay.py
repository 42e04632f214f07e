"""A log gives back its run, bit for bit, at any control rate, with nothing else told."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.acceptance.check import Check, Count, Figures, Job, Worst, exactly
from benchmarks.acceptance.commands import command, empty_folder, log_of
from models import SCENARIOS

RATES = (17.0, 20.0, 33.0, 40.0, 50.0, 60.0, 100.0)
"""[Hz] From the paper's slowest on; some divide the stick's 20 Hz, others do not."""
DURATION = 20.0
PRESSES = "t,k_x,k_y,gripper,reverse,start,stop"
WITH_PAUSES = (
    "0.5,0,0,0,0,1,0",
    "0.6,0,0,0,0,0,0",
    "3.0,0.7,-0.5,0,0,0,0",
    "3.4,0,0,0,0,0,0",
    "5.0,0,0,0,0,1,0",  # a pause
    "5.1,0,0,0,0,0,0",
    "6.0,-0.4,0.9,0,0,0,0",
    "6.5,0,0,0,0,0,0",
    "7.0,0,0,0,0,1,0",
    "7.1,0,0,0,0,0,0",
    "8.0,0,0,0,1,0,0",
    "8.1,0,0,0,0,0,0",
    "10.0,0,0,0,0,0,1",  # a stop
    "10.1,0,0,0,0,0,0",
    "12.0,0,0,0,0,1,0",
    "12.1,0,0,1,0,0,0",
    "12.2,0,0,0,0,0,0",
    "30.0,0,0,0,0,0,0",
)
"""A person's twenty seconds: corrections, a pause, a reversal, a stop, a grip."""


def _differing(a: Path, b: Path) -> list[str]:
    """Names of the signals and events in which two logs differ in a bit; who was told what may differ."""
    first, second = log_of(a), log_of(b)
    ticks = len(first["time"])
    names = [n for n, s in first.items() if n.startswith("event") or (s.ndim > 0 and len(s) == ticks)]
    return [n for n in names if n not in second or not _same(first[n], second[n])]


def _same(a: np.ndarray, b: np.ndarray) -> bool:
    return np.array_equal(a, b, equal_nan=a.dtype.kind == "f" and b.dtype.kind == "f")


def replay(scenario: str, items: str, rate: float | None, person: bool) -> Figures:
    """A run of 20 s and its replay from the log alone."""
    module = "run_laundry" if scenario.startswith("laundry") else "run_relocation"
    with empty_folder() as folder:
        (folder / "s.yaml").write_text(
            (SCENARIOS / f"{scenario}.yaml").read_text() + (f"\ncontrol_rate_hz: {rate}\n" if rate else "")
        )
        (folder / "person.csv").write_text("\n".join((PRESSES, *WITH_PAUSES, "")))
        told = ("--duration", DURATION, "--scenario", "s.yaml", "--items", items, "--seed", 4)
        operator = ("--operator", "person.csv") if person else ()
        first = command(module, "--headless", *told, *operator, "--log", "a.npz", folder=folder)
        again = command(module, "--headless", "--operator", "a.npz", "--log", "b.npz", folder=folder)
        differing = _differing(folder / "a.npz", folder / "b.npz")
        last = float(log_of(folder / "b.npz")["time"][-1])
    print("differing:", differing)
    ran = first.status == again.status == 1 and last > DURATION - 0.1
    return {"whole": float(ran), "differing": len(differing), "same": float(ran and not differing)}


def checks() -> list[Check]:
    """The simulated operator and a person, at several control rates."""
    simulated = [
        Job(replay, ("relocation", "rigid", None, False), 0.2),
        Job(replay, ("laundry", "soft", None, False), 0.4),
    ]
    person = [Job(replay, ("relocation", "rigid", rate, True), 0.2) for rate in RATES]
    lines = (
        Count("replay bit for bit", "same"),
        Worst("signals that differ", "differing", exactly(0)),
        Count("run whole", "whole"),
    )
    return [
        Check("replay of the simulated operator", "12.4", simulated, lines),
        Check("replay of a person, pauses included, 17 to 100 Hz", "12.3, 12.4", person, lines, quick=2),
    ]
