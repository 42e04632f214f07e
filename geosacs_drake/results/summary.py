"""The summary of a run: the study's measures (paper VI), and how well robot and program did."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from canal.files import write_and_rename
from canal.navigation import FIELD_NAMES
from diagrams.ik.options import IkStatus
from diagrams.ik.system import IkStatusField
from diagrams.monitor import ALL_PLACED
from geosacs_drake.results.tracking import Tracking


@dataclass(frozen=True)
class RunResult:
    """What a finished run gives to its summary. Times in simulated seconds."""

    task: str
    seed: int
    reason: str
    item_names: Sequence[str]
    placed_times: np.ndarray
    """When each item came to rest where it belongs; negative where it is not. Shape (n,)."""
    contact_pairs: Sequence[str]
    peak_forces: np.ndarray
    """[N], per pair."""
    peak_joint_speed_share: float
    bound_violations: int
    max_penetration_m: float
    signals: Mapping[str, np.ndarray]
    """Raw signals of `diagrams.run_log.RunLog`."""
    realtime_factors: np.ndarray
    """Simulated over elapsed time of each half second that was simulated."""
    scenario: str = ""
    operator: str = "simulated"
    items_kind: str = "rigid"
    failure: str = ""
    """What ended the run where something inside did, and not the task, the operator, a person or the clock: the
    library's own words."""


def summarize(result: RunResult) -> dict[str, Any]:
    """The summary as plain data, fit for JSON: each key as `geosacs_drake.results.measures` defines it."""
    navigation = {name: result.signals["navigation_state"][:, i] for i, name in enumerate(FIELD_NAMES)}
    running = navigation["running"] > 0
    time = result.signals["time"]
    # A row shows what the tick before it has made of the joystick.
    started = np.flatnonzero(running)
    start = float(time[max(started[0] - 1, 0)]) if started.size else None
    task_time = 0.0 if start is None else float(time[-1]) - start
    correction_time = float(navigation["correction_time_s"][-1])
    placed = result.placed_times >= 0
    success = bool(placed.size > 0 and placed.all() and not result.failure)
    ik = result.signals["ik_status"]
    solve_ms = 1e3 * ik[ik[:, IkStatusField.SOLVE_TIME] > 0, IkStatusField.SOLVE_TIME]
    tracking = Tracking(result.signals, running)
    error, factors = tracking.errors(), result.realtime_factors
    return {
        "task": result.task,
        "scenario": result.scenario,
        "operator": result.operator,
        "items_kind": result.items_kind,
        "success": success,
        "reason": _reason(result, success, alarm=bool(navigation["alarm"][-1])),
        "seed": result.seed,
        "items": [
            {"name": name, "placed": bool(ok), "time_s": _since(start, when) if ok else None}
            for name, ok, when in zip(result.item_names, placed, result.placed_times, strict=True)
        ],
        "task_time_s": _rounded(task_time, 3),
        "correction_time_s": _rounded(correction_time, 3),
        "correction_share": _rounded(correction_time / task_time if task_time > 0 else 0.0, 5),
        "corrections": int(navigation["corrections"][-1]),
        "correction_distance_m": _rounded(navigation["correction_distance_m"][-1], 5),
        "measured_correction_distance_m": _rounded(tracking.way(np.diff(navigation["correction_time_s"]) > 0), 5),
        "backtracks": int(navigation["backtracks"][-1]),
        "ik": {
            "p50_ms": _percentile(solve_ms, 50, 4),
            "p99_ms": _percentile(solve_ms, 99, 4),
            "bound_violations": result.bound_violations,
            "held_ticks": int((ik[:, IkStatusField.STATUS] == IkStatus.HELD).sum()),
        },
        "peak_joint_speed_share": _rounded(result.peak_joint_speed_share, 4),
        "max_contact_force_n": {
            pair: _rounded(force, 2) for pair, force in zip(result.contact_pairs, result.peak_forces, strict=True)
        },
        "max_penetration_m": _rounded(result.max_penetration_m, 6),
        "tcp_error_m": {
            "p50": _percentile(error, 50, 6),
            "p95": _percentile(error, 95, 6),
            "max": _percentile(error, 100, 6),
        },
        "delay_ms": None if tracking.delay_s is None else _rounded(1e3 * tracking.delay_s, 1),
        "realtime_factor": _rounded(len(factors) / (1 / factors).sum(), 3) if len(factors) else None,
        "realtime_factor_worst_half_second": _rounded(factors.min(), 3) if len(factors) else None,
        "version": version("geosacs-drake"),
    } | ({"failure": result.failure} if result.failure else {})


def _since(start: float | None, when: float) -> float | None:
    """Time after the start, to a millisecond; 0 for what had always been so, None where nobody started."""
    return None if start is None else _rounded(max(when - start, 0.0), 3)


def _reason(result: RunResult, success: bool, *, alarm: bool) -> str:
    """Why the run ended, such that it does not contradict whether the task was done."""
    if success and result.reason != ALL_PLACED:
        return f"{ALL_PLACED} ({result.reason})"
    if not success and alarm and not result.failure:
        return f"{result.reason}, with a contact force above its limit"
    return result.reason


WALL_CLOCK_KEYS = ("ik.p50_ms", "ik.p99_ms", "realtime_factor", "realtime_factor_worst_half_second")
"""What two runs with one seed may differ in."""


def write_summary(path: Path, summary: Mapping[str, Any]) -> None:
    """Write a summary as JSON, to a temporary file that is then renamed.

    Args:
        path: file to write.
        summary: what `summarize` gives.
    """
    text = json.dumps(summary, indent=2, allow_nan=False) + "\n"
    write_and_rename(path, lambda stream: stream.write(text.encode()))


def describe(summary: Mapping[str, Any]) -> str:
    """The summary as a person reads it at the end of a run."""
    placed = sum(item["placed"] for item in summary["items"])
    lines = [
        f"{summary['task']}: {'done' if summary['success'] else 'not done'}, {summary['reason']}",
        f"  {placed} of {len(summary['items'])} placed in {summary['task_time_s']:.1f} s, "
        f"{summary['corrections']} corrections over {100 * summary['correction_share']:.1f} % of the time, "
        f"{summary['backtracks']} reversals",
    ]
    if summary["realtime_factor"] is not None:
        lines.append(
            f"  simulated at {summary['realtime_factor']:.1f} times real time "
            f"(worst half second {summary['realtime_factor_worst_half_second']:.1f})"
        )
    return "\n".join(lines)


def _rounded(value: float, digits: int) -> float | None:
    """A plain float with so many digits; None for what is not finite (JSON knows no NaN)."""
    return round(float(value), digits) if math.isfinite(value) else None


def _percentile(values: np.ndarray, percent: float, digits: int) -> float | None:
    return _rounded(float(np.percentile(values, percent)), digits) if values.size else None
