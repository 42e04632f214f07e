"""One's own recordings do the task: the recorded pair, and pairs that nothing was ever tuned to."""

from __future__ import annotations

import numpy as np

from benchmarks.acceptance.check import Check, Count, Figures, Job, Worst, at_most, exactly
from benchmarks.acceptance.commands import command, empty_folder, log_of, summary_of
from benchmarks.canal_quality import RECORDED
from canal.surface import CanalSurface

MINUTES = 0.3
_LINES = (
    Count("carry 3 of 3", "success"),
    Worst("disks of the canal that were not travelled", "left out", at_most(1.0)),
    Worst("surroundings", "surroundings", exactly(0, "N")),
    Worst("tool error", "tool error", at_most(20, "mm")),
    Worst("joint speed, of its limit", "joint speed", at_most(1.0)),
)


def recorded_pair(seed: int) -> Figures:
    """The real robot's two recordings, given as a person gives them."""
    with empty_folder() as folder:
        demos = [path.resolve() for path in sorted(RECORDED.glob("*.npz"))]
        command("learn", *demos, "-o", "canal.npz", folder=folder)
        canal = CanalSurface.load(folder / "canal.npz")
        files = ("--summary", "s.json", "--log", "l.npz")
        ended = command("run_relocation", "--headless", "--demos", *demos, "--seed", seed, *files, folder=folder)
        summary, disk = summary_of(folder / "s.json"), log_of(folder / "l.npz")["disk"]
    print(summary)
    return {
        "success": float(ended.status == 0 and summary["success"]),
        "left out": canal.n_disks - 1 - float(np.ptp(disk)),
        "surroundings": max(summary["max_contact_force_n"].values()),
        "tool error": 1e3 * summary["tcp_error_m"]["max"],
        "joint speed": summary["peak_joint_speed_share"],
    }


def checks() -> list[Check]:
    """The recordings, when they lie beside the project."""
    absent = "" if len(list(RECORDED.glob("*.npz"))) == 2 else f"no recordings in {RECORDED}"
    jobs = [Job(recorded_pair, (seed,), MINUTES) for seed in range(10)]
    return [Check("recorded pair, relocation", "12.2", jobs, _LINES, missing=absent)]
