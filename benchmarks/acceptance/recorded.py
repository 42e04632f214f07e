"""One's own recordings do the task: the recorded pair, and pairs that nothing was ever tuned to."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.acceptance.check import Check, Count, Figures, Job, Worst, at_most, exactly
from benchmarks.acceptance.commands import command, empty_folder, log_of, summary_of
from benchmarks.canal_quality import HAND_GUIDED, RECORDED, hard_demonstrations
from canal.demonstration import save_demonstration
from canal.surface import CanalSurface

MINUTES = 0.3
FIRST_HELD_BACK = 100
"""Seed of the first pair; those below were looked at when the fitting was made."""
_LINES = (
    Count("carry 3 of 3", "success"),
    Worst("disks of the canal that were not travelled", "left out", at_most(1.0)),
    Worst("surroundings", "surroundings", exactly(0, "N")),
    Worst("tool error", "tool error", at_most(20, "mm")),
    Worst("joint speed, of its limit", "joint speed", at_most(1.0)),
)


def recorded_pair(seed: int) -> Figures:
    """The real robot's two recordings, given as a person gives them."""
    return _carried([path.resolve() for path in sorted(RECORDED.glob("*.npz"))], seed)


def generated_pair(seed: int) -> Figures:
    """Two recordings as a person's who leads the Lio by its hand, of a seed that no test knows."""
    with empty_folder() as folder:
        demos = [folder / f"{k}.npz" for k in (1, 2)]
        for path, demonstration in zip(demos, hard_demonstrations(seed, hardness=HAND_GUIDED), strict=True):
            save_demonstration(path, demonstration)
        return _carried(demos, seed)


def _carried(demos: list[Path], seed: int) -> Figures:
    """What comes of a relocation by the canal that is learned from these files."""
    with empty_folder() as folder:
        command("learn", *demos, "-o", "canal.npz", folder=folder)
        canal = CanalSurface.load(folder / "canal.npz")
        files = ("--summary", "s.json", "--log", "l.npz")
        ended = command("run_relocation", "--headless", "--demos", *demos, "--seed", seed, *files, folder=folder)
        summary, disk = summary_of(folder / "s.json"), log_of(folder / "l.npz")["disk"]
    print(summary)
    return {
        "success": float(ended.status == 0 and summary["success"] and len(summary["items"]) == 3),
        "left out": canal.n_disks - 1 - float(np.ptp(disk)),
        "surroundings": max(summary["max_contact_force_n"].values()),
        "tool error": 1e3 * summary["tcp_error_m"]["max"],
        "joint speed": summary["peak_joint_speed_share"],
    }


def checks() -> list[Check]:
    """The recordings, when they lie beside the project."""
    absent = "" if len(list(RECORDED.glob("*.npz"))) == 2 else f"no recordings in {RECORDED}"
    jobs = [Job(recorded_pair, (seed,), MINUTES) for seed in range(10)]
    generated = [Job(generated_pair, (seed,), MINUTES) for seed in range(FIRST_HELD_BACK, FIRST_HELD_BACK + 20)]
    most = Count("carry 3 of 3", "success", share=0.9)
    return [
        Check("recorded pair, relocation", "12.2", jobs, _LINES, missing=absent),
        Check("generated pairs, relocation", "12.2", generated, (most,)),
    ]
