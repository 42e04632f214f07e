"""A canal that was shown faster than the joints turn is travelled at what they allow."""

from dataclasses import replace

import numpy as np
import pytest

from canal.navigation import NavigationOptions, disks_per_second
from diagrams.ik.joint_pace import SHARE, at_joint_pace, busiest_joint, unhurried
from diagrams.ik.start_posture import find_start_posture
from diagrams.scenario import load_scenario
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions


@pytest.fixture(scope="module")
def run():
    scenario = load_scenario("relocation")
    canal, solver = prepare_canal(scenario, RunOptions()), make_lio_solver(scenario, scenario.ik)
    return solver, canal, find_start_posture(solver, canal, preferred=START_POSTURE)


def test_the_shipped_pace_is_kept(run):
    solver, canal, start = run
    assert unhurried(canal) is canal
    options = NavigationOptions()
    assert at_joint_pace(solver, canal, start, options) == (options, None)


@pytest.mark.parametrize(("shown_in", "scale"), [(0.5, 1.0), (None, 4.0), (0.5, 4.0)])
def test_a_pace_beyond_the_joints_is_lowered_to_what_they_allow(run, shown_in, scale):
    solver, canal, start = run
    fast = replace(canal, moving_time_s=shown_in) if shown_in else canal
    options, line = at_joint_pace(solver, fast, start, NavigationOptions(speed_scale=scale))
    assert line is not None
    assert "lio_joint" in line
    assert "\n" not in line
    speeds = np.abs(np.diff(start.path, axis=0)) * disks_per_second(fast, options)
    assert np.all(speeds <= SHARE * solver.v_max * 1.001)
    # The same pace, however fast it was shown.
    slow, _ = at_joint_pace(solver, canal, start, NavigationOptions(speed_scale=50.0))
    assert disks_per_second(fast, options) == pytest.approx(disks_per_second(canal, slow), rel=1e-9)


def test_the_branch_does_not_depend_on_how_fast_it_was_shown(run):
    solver, canal, start = run
    fast = unhurried(replace(canal, moving_time_s=0.5))
    again = find_start_posture(solver, fast, preferred=START_POSTURE)
    assert again.q == pytest.approx(start.q, abs=0.02)
    assert again.followed.mean() > 0.99


def test_the_rim_counts(run):
    solver, canal, start = run
    directrix = (
        np.abs(np.diff(start.path, axis=0)).max() / (canal.moving_time_s / (canal.n_disks - 1)) / solver.v_max[0]
    )
    assert busiest_joint(solver, canal, start)[0] > 1.5 * directrix
