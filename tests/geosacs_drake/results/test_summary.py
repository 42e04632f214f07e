"""The summary from made-up signals: each figure against what was put in."""

import json

import numpy as np
import pytest

from canal.navigation import FIELD_NAMES
from diagrams.ik.options import IkStatus
from diagrams.ik.system import IkStatusField
from geosacs_drake.results.measures import MEASURES
from geosacs_drake.results.summary import RunResult, describe, summarize, write_summary

TICKS = 1001
TIME = np.arange(TICKS) * 0.01


def result(**changes) -> RunResult:
    navigation = np.zeros((TICKS, len(FIELD_NAMES)))
    navigation[101:, FIELD_NAMES.index("running")] = 1.0
    navigation[-1, FIELD_NAMES.index("correction_time_s")] = 0.9
    navigation[-1, FIELD_NAMES.index("corrections")] = 4
    navigation[-1, FIELD_NAMES.index("backtracks")] = 2
    navigation[-1, FIELD_NAMES.index("correction_distance_m")] = 0.123
    ik = np.zeros((TICKS, len(IkStatusField)))
    ik[:, IkStatusField.SOLVE_TIME] = 2e-4
    ik[8:11, IkStatusField.STATUS] = IkStatus.HELD
    pose = np.tile([0.4, 0.0, 1.0, 1, 0, 0, 0], (TICKS, 1))
    off = pose + [0.003, 0, 0.004, 0, 0, 0, 0]
    values = {
        "task": "laundry",
        "seed": 3,
        "reason": "every item is placed",
        "item_names": ["sock", "towel"],
        "placed_times": np.array([4.0, 9.5]),
        "contact_pairs": ["lio-machine"],
        "peak_forces": np.array([12.345]),
        "peak_joint_speed_share": 0.8,
        "bound_violations": 1,
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
    assert summary["items"][1] == {"name": "towel", "placed": True, "time_s": 8.5}
    assert summary["task_time_s"] == pytest.approx(9.0)
    assert summary["correction_share"] == pytest.approx(0.1)
    assert (summary["corrections"], summary["backtracks"]) == (4, 2)
    assert summary["ik"] == {"p50_ms": 0.2, "p99_ms": 0.2, "bound_violations": 1, "held_ticks": 3}
    assert summary["tcp_error_m"]["p95"] == pytest.approx(0.005)
    assert summary["max_contact_force_n"] == {"lio-machine": 12.35}
    # One simulated second in 0.1 + 0.2 s, each half second at its own factor.
    assert summary["realtime_factor"] == pytest.approx(2 / (1 / 10 + 1 / 5), abs=1e-3)
    assert summary["realtime_factor_worst_half_second"] == 5.0


def travelling(period: float = 0.02, delay: float = 0.04, off: float = 0.0, rows: int = 400) -> dict[str, np.ndarray]:
    """The log of a tool that goes 0.1 m/s along x, is pushed 60 mm along y in between, and lags by `delay`.

    A row has what the tick before wanted, and where the tool was `delay` after it was wanted, `off` beside it along z.
    """
    time = period * np.arange(rows)

    def wanted(at):
        at = np.round(at, 9)
        return np.column_stack([0.1 * at, 0.2 * np.clip(at - 4.0, 0.0, 0.3), 0 * at])

    navigation = np.zeros((rows, len(FIELD_NAMES)))
    navigation[1:, FIELD_NAMES.index("running")] = 1.0
    ticks = np.round(time - period, 9)  # when what a row shows was decided
    navigation[:, FIELD_NAMES.index("correcting")] = (ticks > 4.0 + 1e-9) & (ticks < 4.3 + 1e-9)
    navigation[:, FIELD_NAMES.index("correction_time_s")] = np.round(np.clip(ticks - 4.0, 0.0, 0.3), 9)
    pose = np.zeros((rows, 7))
    measured = pose.copy()
    pose[:, :3], measured[:, :3] = wanted(ticks), wanted(time - delay) + [0, 0, off]
    return {
        "time": time,
        "navigation_state": navigation,
        "ik_status": np.zeros((rows, len(IkStatusField))),
        "X_BT": measured,
        "X_BT_desired": pose,
    }


def test_error_is_of_one_instant_and_the_delay_stands_beside_it():
    summary = summarize(result(signals=travelling(off=0.0004)))
    assert summary["tcp_error_m"]["max"] == pytest.approx(0.0004)
    assert summary["delay_ms"] == pytest.approx(40, abs=0.5)
    # A tool that lags by 10 ms more is 1 mm behind, and 2.2 mm in the push.
    late = summarize(result(signals=travelling(delay=0.05)))
    assert late["tcp_error_m"]["p50"] == pytest.approx(0.001)
    assert late["tcp_error_m"]["max"] == pytest.approx(0.01 * np.hypot(0.1, 0.2), abs=1e-6)
    assert late["delay_ms"] == pytest.approx(50, abs=0.5)


@pytest.mark.parametrize("delay", [0.04, 0.05, 0.09])
def test_measured_distance_has_the_whole_push(delay):
    # All of 0.3 s at 0.1 m/s along and 0.2 m/s across; its first step and its last two ticks are a fifth. Between
    # ticks a corner is cut by half a step.
    summary = summarize(result(signals=travelling(delay=delay)))
    assert summary["measured_correction_distance_m"] == pytest.approx(0.3 * np.hypot(0.1, 0.2), rel=0.03)


@pytest.mark.parametrize(
    ("changes", "success", "says"),
    [
        ({}, True, "every item is placed"),
        ({"reason": "time is up after 10 s"}, True, "every item is placed (time is up after 10 s)"),
        ({"reason": "interrupted", "placed_times": np.array([4.0, -1.0])}, False, "interrupted"),
        ({"reason": "the solver failed at 3 s", "failure": "SAP"}, False, "the solver failed at 3 s"),
    ],
)
def test_reason_fits_success(changes, success, says):
    summary = summarize(result(**changes))
    assert (summary["success"], summary["reason"]) == (success, says)


def test_a_run_that_ends_pressing_says_so():
    signals = dict(result().signals)
    signals["navigation_state"][-1, FIELD_NAMES.index("alarm")] = 1.0
    summary = summarize(result(signals=signals, placed_times=np.array([4.0, -1.0]), reason="time is up after 10 s"))
    assert summary["reason"] == "time is up after 10 s, with a contact force above its limit"


def test_what_lay_on_its_mark_before_the_start_took_no_time():
    assert summarize(result(placed_times=np.array([0.5, 9.5])))["items"][0]["time_s"] == 0


def keys_of(data: dict, before: str = "") -> set[str]:
    """All keys of a summary as `MEASURES` names them."""
    found: set[str] = set()
    for key, value in data.items():
        if key == "max_contact_force_n" or not isinstance(value, dict | list):
            found.add(before + key)
        else:
            found |= keys_of(value[0] if isinstance(value, list) else value, f"{before}{key}.")
    return found


def test_each_figure_has_one_definition():
    keys = [measure.key for measure in MEASURES]
    assert len(keys) == len(set(keys))
    assert keys_of(summarize(result(failure="SAP"))) == set(keys)


def test_one_item_short_is_no_success():
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
