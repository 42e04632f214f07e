"""The inverse kinematics' floors, from one run of `benchmarks.bench_ik`."""

from __future__ import annotations

import csv
import subprocess
import sys

from benchmarks.acceptance.check import Check, Figures, Job, Worst, at_least, at_most, exactly
from benchmarks.acceptance.commands import empty_folder
from benchmarks.canal_quality import ROOT

PANOC = "PANOC, differences"
NOVEMBER_RATIO = 14.7
"""Times that PANOC with differences, tight, took as long as the solver of November 2026 (before issue 12)."""


def floors(fuzzed: int) -> Figures:
    """Ratios to rivals, gaps, times, what keeping clear keeps, and what nonsense does."""
    with empty_folder() as folder:
        file = folder / "ik.csv"
        arguments = ("--every", "60", "--paced", "300", "--exact", "25", "--fuzz", str(fuzzed), "--output", str(file))
        subprocess.run([sys.executable, "-m", "benchmarks.bench_ik", *arguments], cwd=ROOT, check=True)
        with file.open(newline="") as stream:
            rows = {(r["case"], r["contender"], r["metric"]): float(r["value"]) for r in csv.DictReader(stream)}
    wanted = {
        "panoc": ("demonstrations, tight", PANOC, "time over this"),
        "paced p99": ("demonstrations, paced", "this", "time p99"),
        "median": ("demonstrations, tight", "this", "time median"),
        "within": ("demonstrations, exactness", "this", "gap within 1e-6"),
        "clear": ("keeping clear", "this", "least distance"),
        "clear violation": ("keeping clear", "this", "bound violation max"),
        "exceptions": ("fuzz", "this", "exceptions"),
        "not finite": ("fuzz", "this", "not finite"),
        "step": ("fuzz", "this", "largest step over v dt"),
        "limits": ("fuzz", "this", "largest excess over limits"),
    }
    print(rows)
    return {name: rows[key] for name, key in wanted.items() if key in rows}


def checks() -> list[Check]:
    """One run of the benchmark."""
    slower = 1.5
    lines = (
        Worst("PANOC with differences, times this", "panoc", at_least(5)),
        Worst(f"the same, within {slower:g} times November's", "panoc", at_least(round(NOVEMBER_RATIO / slower, 1))),
        Worst("paced p99", "paced p99", at_most(1000, "us")),
        Worst("ticks within 1e-6 of the best", "within", at_least(99.9, "%")),
        Worst("keeping clear: least distance of 20", "clear", at_least(19.9, "mm")),
        Worst("keeping clear: over bounds", "clear violation", at_most(1e-9, "rad")),
        Worst("fuzzed: exceptions", "exceptions", exactly(0)),
        Worst("fuzzed: not finite", "not finite", exactly(0)),
        Worst("fuzzed: step over v dt", "step", at_most(1e-9, "rad")),
        Worst("fuzzed: over limits", "limits", at_most(1e-9, "rad")),
    )
    return [Check("inverse kinematics", "4, 12.6", [Job(floors, (20_000,), 2.0)], lines, alone=True)]
