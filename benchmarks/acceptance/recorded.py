"""One's own recordings do the task: the recorded pair, and pairs that nothing was ever tuned to."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.acceptance.check import Check, Count, Figures, Job, Worst, at_most, exactly
from benchmarks.acceptance.commands import command, empty_folder, log_of, summary_of
from benchmarks.canal_quality import HAND_GUIDED, RECORDED, hard_demonstrations
from canal.demonstration import save_demonstration
from canal.surface_file import load_canal

MINUTES = 0.4
HELD_BACK = range(7100, 7124)
"""Seeds of the tests' generator that no test looks at: 20 pairs within reach, and some that are not."""
WITHIN_REACH = 20
ITEMS = ["apple", "cube", "cup"]
_RUNS = (
    Worst("disks of the canal that were not travelled", "left out", at_most(1.0)),
    Worst("surroundings", "surroundings", at_most(140, "N")),
    Worst("tool error", "tool error", at_most(20, "mm")),
    Worst("joint speed, of its limit", "joint speed", at_most(1.0)),
    Worst("bound violations", "bound violations", exactly(0)),
)
"""What holds in runs on the recordings; 140 N is ISO/TS 15066's bound for a hand."""


def recorded_pair(seed: int) -> Figures:
    """The real robot's two recordings, given as a person gives them."""
    return _carried([path.resolve() for path in sorted(RECORDED.glob("*.npz"))], seed)


def generated_pair(seed: int) -> Figures:
    """Two demonstrations as a person leads the robot's hand; within reach when the run finds room for all items."""
    with empty_folder() as folder:
        demos = [folder / f"{k}.npz" for k in (1, 2)]
        for path, demonstration in zip(demos, hard_demonstrations(seed, 2, hardness=HAND_GUIDED), strict=True):
            save_demonstration(path, demonstration)
        return _carried(demos, seed)


def _carried(demos: Sequence[Path], seed: int) -> Figures:
    """A relocation on the canal of some demonstrations, with nothing else said."""
    with empty_folder() as folder:
        command("learn", *demos, "-o", "canal.npz", folder=folder)
        canal = load_canal(folder / "canal.npz")
        files = ("--summary", "s.json", "--log", "l.npz")
        ended = command("run_relocation", "--headless", "--demos", *demos, "--seed", seed, *files, folder=folder)
        if not (folder / "s.json").exists():
            return {"success": 0.0, "within reach": 0.0, "did what it can": float(ended.status == 2)}
        summary, disk = summary_of(folder / "s.json"), log_of(folder / "l.npz")["disk"]
    print(summary)
    placed = [item["name"] for item in summary["items"] if item["placed"]]
    return {
        "success": float(ended.status == 0 and sorted(placed) == ITEMS),
        "within reach": float(len(summary["items"]) == len(ITEMS)),
        "did what it can": float(ended.status == 0 and len(placed) == len(summary["items"]) > 0),
        "left out": canal.n_disks - 1 - float(np.ptp(disk)),
        "surroundings": max(summary["max_contact_force_n"].values()),
        "tool error": 1e3 * summary["tcp_error_m"]["max"],
        "joint speed": summary["peak_joint_speed_share"],
        "bound violations": summary["ik"]["bound_violations"],
    }


def checks() -> list[Check]:
    """The recordings, when they lie beside the project, and held-back pairs always."""
    absent = "" if len(list(RECORDED.glob("*.npz"))) == 2 else f"no recordings in {RECORDED}"
    of_recorded = [Job(recorded_pair, (seed,), MINUTES) for seed in range(10)]
    held_back = [Job(generated_pair, (seed,), MINUTES) for seed in HELD_BACK]
    carried = Count("carry apple, cup and cube", "success")
    return [
        Check("recorded pair, relocation", "12.2", of_recorded, (carried, *_RUNS), missing=absent),
        Check(
            "generated pairs, relocation",
            "12.2",
            held_back,
            (
                Count("find room for apple, cup and cube", "within reach", WITHIN_REACH / len(HELD_BACK)),
                Count("with room, carry apple, cup and cube", "success", 0.9, among="within reach"),
                Count("carry what they find room for, or refuse", "did what it can", 0.9),
            ),
        ),
    ]
