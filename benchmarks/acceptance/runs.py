"""Whole runs of the shipped scenarios: whether they succeed, and what is seen of them at every step."""

from __future__ import annotations

import math

import numpy as np
from pydrake.systems.framework import Context

from benchmarks.acceptance.check import Check, Count, Figures, Job, Worst, at_least, at_most, exactly
from benchmarks.bench_world import WatchedRun, watched_run
from canal.navigation import FIELD_NAMES
from diagrams.shared_autonomy import SharedAutonomy

RIGID_MIN, RELOCATION_MIN, SOFT_MIN = 0.30, 0.25, 0.60
"""Minutes of one core that a run takes, watched, on the machine of November 2026."""
JOINT_SPEED = math.radians(95.0)
"""[rad/s] of every joint (docs/method.md, 6)."""


class _JointSpeeds:
    """The greatest speed of any joint of the arm, at each step of the plant [rad/s]."""

    def __init__(self) -> None:
        self.peak = 0.0

    def __call__(self, system: SharedAutonomy, root: Context) -> None:
        station = system.station
        v = station.plant.GetVelocities(station.plant_context(root), station.scene.lio)[:6]
        self.peak = max(self.peak, float(np.abs(v).max()))


def whole_run(scenario: str, items: str | None, seed: int, orientation: bool = True) -> Figures:
    """One run by the simulated operator, looked at at every step."""
    speeds = _JointSpeeds()
    run = watched_run(scenario, items, seed, orientation=orientation, also=speeds)
    summary, depth = run.summary, np.array(run.watch.penetration)
    forces = summary["max_contact_force_n"]
    print(run.result.reason, summary)
    return {
        "success": float(summary["success"]),
        "task time": summary["task_time_s"],
        "correction share": 100 * summary["correction_share"],
        "backtracks": summary["backtracks"],
        "penetration": 1e3 * float(depth.max()),
        "ticks deeper than 5 mm": float((depth > 5e-3).sum()),
        "slip": 1e3 * max(run.watch.slip.values(), default=math.nan),
        "tool error": 1e3 * summary["tcp_error_m"]["max"],
        "delay": summary["delay_ms"],
        "machine": forces.get("lio-machine", 0.0),
        "surroundings": max(forces.values()),
        "bound violations": summary["ik"]["bound_violations"],
        "held ticks": summary["ik"]["held_ticks"],
        "joint speed": speeds.peak / JOINT_SPEED,
        "not finite": _not_finite(run),
        "off the disk": _off_the_disk(run),
        "summary": _summary_against_log(run),
    }


def _not_finite(run: WatchedRun) -> int:
    """Samples of the log that are not finite, but for those of the IK's status that say so."""
    signals = run.result.signals
    return sum(int((~np.isfinite(s)).sum()) for name, s in signals.items() if name != "ik_status")


def _off_the_disk(run: WatchedRun) -> int:
    """Ticks with η outside [0, 1]."""
    eta = run.result.signals["navigation_state"][:, FIELD_NAMES.index("eta")]
    return int((~((eta >= 0) & (eta <= 1))).sum())


def _summary_against_log(run: WatchedRun) -> int:
    """How many of the summary's figures the log contradicts."""
    signals, summary = run.result.signals, run.summary
    state = {name: signals["navigation_state"][:, k] for k, name in enumerate(FIELD_NAMES)}
    time, running = signals["time"], state["running"] > 0
    start = time[np.argmax(running)]
    whole = time[-1] - start
    tick = float(np.median(np.diff(time)))
    correcting = tick * float((state["correcting"] > 0).sum())
    # Commanded: length of the target's way while the stick moves it on its disk.
    steps = np.linalg.norm(np.diff(signals["X_BT_desired"][:, :3], axis=0), axis=1)
    commanded = float(steps[state["correcting"][1:] > 0].sum())
    forces = signals["contact_forces"].max(axis=0)
    times = [item["time_s"] for item in summary["items"] if item["placed"]]
    contradicted = {
        "task time": abs(summary["task_time_s"] - whole) > 2 * tick,
        "correction time": abs(summary["correction_time_s"] - correcting) > 2 * tick,
        "share": abs(summary["correction_share"] - summary["correction_time_s"] / whole) > 1e-3,
        "corrections": summary["corrections"] != int((np.diff(state["correcting"]) > 0).sum()),
        "commanded distance": abs(summary["correction_distance_m"] - commanded) > 0.01 + 0.02 * commanded,
        "measured distance": abs(summary["measured_correction_distance_m"] - commanded) > 0.01 + 0.1 * commanded,
        "peak forces": bool((np.array(list(summary["max_contact_force_n"].values())) < forces - 0.01).any()),
        "placed times": any(not 0 < t <= summary["task_time_s"] + 2 * tick for t in times),
        "success": summary["success"] != all(item["placed"] for item in summary["items"]),
    }
    print("contradicted by the log:", [name for name, wrong in contradicted.items() if wrong])
    return sum(contradicted.values())


WELL = (
    Worst("joint speed, of its limit, any step", "joint speed", at_most(1.0)),
    Worst("bound violations", "bound violations", exactly(0)),
    Worst("samples that are not finite", "not finite", exactly(0)),
    Worst("ticks off the disk", "off the disk", exactly(0)),
    Worst("figures that the log contradicts", "summary", exactly(0)),
    Worst("tool error", "tool error", at_most(20, "mm")),
    Worst("delay", "delay", at_most(60, "ms")),
)
"""What holds in every run."""


def _of(name: str, section: str, scenario: str, items: str | None, seeds: int, minutes: float, *more) -> Check:
    jobs = [Job(whole_run, (scenario, items, seed), minutes) for seed in range(seeds)]
    return Check(name, section, jobs, (Count("succeed", "success"), *more, *WELL))


def checks() -> list[Check]:
    """Seeds of each task and scenario."""
    untouched = Worst("machine", "machine", exactly(0, "N"))
    bent = (untouched, Worst("penetration, any 10 ms", "penetration", at_most(6, "mm")))
    carried = (
        Worst("penetration, any 10 ms", "penetration", at_most(5, "mm")),
        Worst("slip in a carry", "slip", at_most(3, "mm")),
    )
    quick = Worst("task time", "task time", at_most(175, "s"))
    return [
        _of("laundry, soft", "5, 12.9", "laundry", "soft", 20, SOFT_MIN, untouched, *carried, quick),
        _of("laundry, rigid", "5, 12.9", "laundry", "rigid", 20, RIGID_MIN, untouched, *carried),
        _of(
            "relocation",
            "2, 5, 12.9",
            "relocation",
            None,
            20,
            RELOCATION_MIN,
            Worst("surroundings", "surroundings", exactly(0, "N")),
            *carried,
        ),
        _of(
            "laundry-hanging, soft",
            "5",
            "laundry-hanging",
            "soft",
            3,
            SOFT_MIN,
            untouched,
            Worst("backtracks", "backtracks", at_least(1)),
            Worst("penetration, any 10 ms", "penetration", at_most(6, "mm")),
        ),
        _of("laundry-turned", "3, 5", "laundry-turned", "rigid", 3, RIGID_MIN, *bent),
        _of("laundry-moved", "3, 5", "laundry-moved", "rigid", 3, RIGID_MIN, *bent),
        _of("laundry-narrow", "5", "laundry-narrow", "rigid", 1, RIGID_MIN, untouched),
        _of("laundry-crowded", "5", "laundry-crowded", "rigid", 1, RIGID_MIN, untouched),
        _of("laundry-straight", "5", "laundry-straight", "rigid", 1, RIGID_MIN, untouched),
        _of("relocation-far", "5", "relocation-far", None, 1, RELOCATION_MIN),
        Check(
            "laundry without orientation",
            "5",
            [Job(whole_run, ("laundry", "rigid", seed, False), RIGID_MIN) for seed in range(2)],
            (Worst("machine", "machine", at_least(150, "N")),),
        ),
    ]
