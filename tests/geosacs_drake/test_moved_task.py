"""A task that has moved since it was shown: the canal ends where it is now, and the arm follows it there."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diagrams.ik.start_posture import find_start_posture
from diagrams.scenario import Retarget, load_scenario
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions


@pytest.fixture(scope="module")
def shown():
    return prepare_canal(load_scenario("laundry"), RunOptions())


@pytest.mark.parametrize("name", ["laundry-moved", "laundry-turned"])
def test_the_canal_ends_where_the_scenario_says(name, shown):
    scenario = load_scenario(name)
    moved = prepare_canal(scenario, RunOptions())
    to = scenario.retarget
    for disk, position, yaw_deg in ((0, to.pick, to.pick_yaw_deg), (-1, to.place, to.place_yaw_deg)):
        assert moved.directrix[disk] == pytest.approx(position, abs=1e-9)
        old, new = (Rotation.from_quat(c.orientations[disk], scalar_first=True) for c in (shown, moved))
        assert (new * old.inv()).as_rotvec(degrees=True) == pytest.approx([0, 0, yaw_deg], abs=1e-6)


def test_a_turn_alone_keeps_the_places(shown):
    scenario = load_scenario("laundry")
    scenario.retarget = Retarget(place_yaw_deg=15.0)
    turned = prepare_canal(scenario, RunOptions())
    assert turned.directrix[[0, -1]] == pytest.approx(shown.directrix[[0, -1]], abs=1e-9)
    assert np.abs(turned.orientations[0] @ shown.orientations[0]) == pytest.approx(1.0, abs=1e-12)
    assert 2 * np.degrees(np.arccos(np.abs(turned.orientations[-1] @ shown.orientations[-1]))) == pytest.approx(15.0)


@pytest.mark.parametrize("name", ["laundry-moved", "laundry-straight", "laundry-turned"])
def test_the_arm_follows_it(name):
    scenario = load_scenario(name)
    canal = prepare_canal(scenario, RunOptions())
    start = find_start_posture(make_lio_solver(scenario, scenario.ik), canal, preferred=START_POSTURE)
    # Where the wrist turns fast its joints' speed is the limit; 10 mm is what the operator may be off anywhere.
    assert start.followed.mean() >= 0.9, start.describe()
    assert start.position_error < 0.010, start.describe()
