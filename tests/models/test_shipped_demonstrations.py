"""The shipped demonstrations have what a hand's recordings have, and are made by their script, to the bit."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from canal.demonstration import load_demonstration
from diagrams.scenario import load_scenario
from models import MODELS
from models.make_demonstrations import HANDS, TASKS, demonstrate

CASES = [(task, k) for task in TASKS for k in (1, 2)]


@pytest.fixture(params=CASES, ids=lambda case: f"{case[0].name}_{case[1]}")
def case(request):
    task, k = request.param
    return task, k, load_demonstration(MODELS / "demonstrations" / f"{task.name}_{k}.npz")


def test_made_by_the_script(case):
    task, k, shipped = case
    position, orientation, _ = demonstrate(task, HANDS[k - 1])
    np.testing.assert_allclose(shipped.position, position, atol=1e-9)
    assert np.abs(np.sum(shipped.orientation * orientation, axis=1)) == pytest.approx(1, abs=1e-9)


def test_imperfect_as_a_hand(case):
    position = case[2].position
    steps = np.linalg.norm(np.diff(position, axis=0), axis=1)
    assert 0.02 < np.mean(steps == 0.0) < 0.09  # samples that repeat the one before
    usual = np.median(steps[steps > 1e-3])
    assert steps.max() > 2.5 * usual  # dropped frames
    assert np.ptp(position[:40], axis=0).max() < 3e-3  # two seconds of rest at the start
    assert np.ptp(position[-40:], axis=0).max() < 3e-3  # and at the end


@pytest.mark.parametrize("task", TASKS, ids=lambda t: t.name)
def test_hands_part_at_pick_and_meet_on_the_way(task):
    one, two = (load_demonstration(MODELS / "demonstrations" / f"{task.name}_{k}.npz") for k in (1, 2))
    assert np.linalg.norm(one.position[0] - two.position[0]) == pytest.approx(0.28, abs=0.02)
    gaps = np.linalg.norm(one.position[:, None, :] - two.position[None, ::4, :], axis=2).min(axis=1)
    assert gaps[len(gaps) // 4 : -len(gaps) // 4].min() < 0.03


def test_laundry_enters_the_door_straight_near_its_middle_and_goes_down():
    scenario = load_scenario("laundry")
    turn, at = Rotation.from_euler("z", scenario.robot.yaw_deg, degrees=True), np.array(scenario.robot.position)
    door = np.array(scenario.drum.center)
    for k in (1, 2):
        demo = load_demonstration(MODELS / "demonstrations" / f"laundry_{k}.npz")
        position = turn.apply(demo.position) + at - door  # y into the machine
        inside = position[:, 1] > -0.02
        assert inside.any()
        forward = (turn * Rotation.from_quat(demo.orientation[inside], scalar_first=True)).apply([1.0, 0.0, 0.0])
        across = position[inside] - forward * (position[inside, 1] / forward[:, 1])[:, None]
        assert np.hypot(across[:, 0], across[:, 2]).max() < 0.095  # the hand is 0.10 wide, the door 0.34
        assert np.hypot(forward[:, 1], forward[:, 2]).min() > np.cos(np.deg2rad(10))
        assert demo.position[-1, 2] < 0.50
