"""The summary from made-up signals: each figure against what was put in."""

import json

import numpy as np
import pytest

from canal.navigation import FIELD_NAMES
from diagrams.ik_options import IkStatus
from diagrams.ik_system import IkStatusField
from geosacs_drake.summary import RunResult, describe, summarize, write_summary

TICKS = 1001
TIME = np.arange(TICKS) * 0.01


def result(**changes) -> RunResult:
    navigation = np.zeros((TICKS, len(FIELD_NAMES)))
    navigation[100:, FIELD_NAMES.index("running")] = 1.0
    navigation[-1, FIELD_NAMES.index("correction_time_s")] = 0.9
    navigation[-1, FIELD_NAMES.index("corrections")] = 4
    navigation[-1, FIELD_NAMES.index("backtracks")] = 2
    navigation[-1, FIELD_NAMES.index("correction_distance_m")] = 0.123
    ik = np.zeros((TICKS, len(IkStatusField)))
    ik[:, IkStatusField.SOLVE_TIME] = 2e-4
    ik[7, IkStatusField.BOUND_VIOLATION] = 1e-3
    ik[8:11, IkStatusField.STATUS] = IkStatus.HELD
    pose = np.tile([0.4, 0.0, 1.0, 1, 0, 0, 0], (TICKS, 1))
    off = pose + [0.003, 0, 0.004, 0, 0, 0, 0]
    values = {
        "task": "laundry",
        "seed": 3,
        "reason": "every thing is in its place",
        "item_names": ["sock", "towel"],
        "placed_times": np.array([4.0, 9.5]),
        "contact_pairs": ["lio-machine"],
        "peak_forces": np.array([12.345]),
        "measured_correction_distance_m": 0.12,
        "max_penetration_m": 0.002,
        "signals": {
            "time": TIME,
            "navigation_state": navigation,
            "ik_status": ik,
            "X_BT": off,
            "X_BT_desired": pose,
        },
        "realtime_factors": np.array([10.0, 5.0]),
    }
    return RunResult(**(values | changes))


def test_figures():
    summary = summarize(result())
    assert summary["success"]
    assert summary["items"][1] == {"name": "towel", "placed": True, "time_s": 9.5}
    assert summary["task_time_s"] == pytest.approx(9.0)
    assert summary["correction_share"] == pytest.approx(0.1)
    assert (summary["corrections"], summary["backtracks"]) == (4, 2)
    assert summary["ik"] == {"p50_ms": 0.2, "p99_ms": 0.2, "bound_violations": 1, "held_ticks": 3}
    assert summary["tcp_error_m"]["p95"] == pytest.approx(0.005)
    assert summary["max_contact_force_n"] == {"lio-machine": 12.35}
    # One simulated second in 0.1 + 0.2 s, each half second at its own factor.
    assert summary["realtime_factor"] == pytest.approx(2 / (1 / 10 + 1 / 5), abs=1e-3)
    assert summary["realtime_factor_worst_half_second"] == 5.0


def test_one_thing_short_is_no_success():
    summary = summarize(result(placed_times=np.array([4.0, -1.0]), reason="time is up"))
    assert not summary["success"]
    assert summary["items"][1] == {"name": "towel", "placed": False, "time_s": None}
    assert "1 of 2 placed" in describe(summary)


def test_a_run_that_never_started_and_nan_are_valid_json(tmp_path):
    quiet = result()
    signals = dict(quiet.signals)
    signals["navigation_state"] = np.zeros_like(signals["navigation_state"])
    summary = summarize(result(signals=signals, peak_forces=np.array([np.nan]), realtime_factors=np.empty(0)))
    path = tmp_path / "s.json"
    write_summary(path, summary)
    again = json.loads(path.read_text())
    assert again["max_contact_force_n"] == {"lio-machine": None}
    assert again["task_time_s"] == 0
    assert again["tcp_error_m"]["p50"] is None
    assert describe(summary)
