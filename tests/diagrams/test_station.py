"""The Lio station: its ports, its controllers, its contact; cheap ones."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from canal.errors import InputError
from diagrams.lio_drive import CLOSE_TARGET, GRIPPER_SPEED, OPEN_ANGLE, LioDrive
from diagrams.lio_station import START_POSTURE, LioStation
from diagrams.pose_vector import pose_to_vector, vector_to_pose
from diagrams.scenario import load_scenario

PORTS = {
    "q": 6, "v": 6, "gripper_state": 2, "X_BT": 7, "item_poses": 21, "item_bounds": 18, "item_speeds": 3,
    "contact_forces": 4, "penetration": 1,
}  # fmt: skip


class Rig:
    """A station alone, its inputs in hand."""

    def __init__(self, name="laundry", seed=0, q0=START_POSTURE, change=None):
        scenario = load_scenario(name)
        for item in scenario.items:
            item.kind = "rigid"
        if change is not None:
            change(scenario)
        self.station = LioStation(scenario, seed=seed, q0=q0)
        self.simulator = Simulator(self.station)
        self.context = self.simulator.get_mutable_context()
        self.wanted = self.station.GetInputPort("desired_state").FixValue(
            self.context, np.concatenate([q0, np.zeros(6)])
        )
        self.grip = self.station.GetInputPort("gripper_command").FixValue(self.context, [0.0])
        self.simulator.Initialize()

    def __getitem__(self, port):
        return self.station.GetOutputPort(port).Eval(self.context)

    def run(self, seconds):
        self.simulator.AdvanceTo(self.context.get_time() + seconds)

    def follow(self, q_of_t, seconds):
        """Command a motion at 100 Hz, and return the largest lag [rad]."""
        begin, worst = self.context.get_time(), 0.0
        for k in range(1, round(100 * seconds) + 1):
            q, v = q_of_t(k / 100), (q_of_t(k / 100) - q_of_t((k - 1) / 100)) * 100
            self.wanted.GetMutableData().set_value(np.concatenate([q, v]))
            self.simulator.AdvanceTo(begin + k / 100)
            worst = max(worst, np.abs(self["q"] - q).max())
        return worst


@pytest.fixture(scope="module")
def laundry():
    return Rig()


def test_ports(laundry):
    assert {name: len(laundry[name]) for name in PORTS} == PORTS
    assert laundry.station.contact_pairs == ["lio-floor", "lio-table", "lio-basket", "lio-machine"]
    assert len(laundry.station.goals) == 3


def test_starts_where_told(laundry):
    assert laundry["q"] == pytest.approx(START_POSTURE, abs=1e-6)
    assert laundry["X_BT"][:3] == pytest.approx([0.170, 0.002, 1.049], abs=2e-3)
    assert laundry["gripper_state"][0] == pytest.approx(OPEN_ANGLE, abs=1e-3)


def test_rests(laundry):
    """Nothing moves by itself: no energy comes from contact at rest, nothing sinks in, nothing is touched."""
    laundry.run(1.0)
    assert laundry["item_speeds"].max() < 0.02
    before = laundry["item_poses"].reshape(-1, 7)[:, :3].copy()
    laundry.run(0.5)
    assert np.abs(laundry["item_poses"].reshape(-1, 7)[:, :3] - before).max() < 2e-3
    assert laundry["item_speeds"].max() < 0.02
    assert laundry["penetration"][0] < 2e-3
    assert laundry["contact_forces"].max() == 0.0
    assert np.abs(laundry["q"] - START_POSTURE).max() < 1e-4


def test_bounds_hold_the_items(laundry):
    for pose, bounds in zip(laundry["item_poses"].reshape(-1, 7), laundry["item_bounds"].reshape(-1, 6), strict=True):
        assert np.all(bounds[:3] < pose[:3])
        assert np.all(pose[:3] < bounds[3:])
        assert bounds[2] == pytest.approx(0.31, abs=3e-3)  # on the basket's floor


def test_follows_with_feed_forward():
    """A swing at up to 1.1 rad/s: the lag stays below half a degree."""
    rig = Rig(change=lambda s: s.items.__delitem__(slice(1, None)))
    swing = np.array([0.35, 0.2, -0.2, 0.3, -0.2, 0.35])
    assert rig.follow(lambda t: START_POSTURE + swing * (1 - np.cos(np.pi * t)) / 2, 1.0) < 0.01


def test_a_touch_is_felt():
    """The hand presses on the table in front of it: the pair that is touched feels it, the others do not."""

    def high_table(scenario):
        scenario.things[1].position = [0.36, 0.0, 0.68]
        scenario.things = [scenario.things[0], scenario.things[1], scenario.things[3]]
        del scenario.items[1:]
        scenario.items[0].start.center = [0.50, 0.25, 0.98]

    rig = Rig(change=high_table)
    down = np.array([0, 0.0, 0.35, 0, 0.25, 0])
    rig.follow(lambda t: START_POSTURE + down * min(t, 1.0), 0.8)
    forces = dict(zip(rig.station.contact_pairs, rig["contact_forces"], strict=True))
    assert forces["lio-table"] > 20.0
    assert forces["lio-machine"] == forces["lio-floor"] == 0.0


@pytest.mark.parametrize("q0", [np.full(6, 3.0), np.zeros(5), np.full(6, np.nan)])
def test_a_posture_that_cannot_be_is_refused(q0):
    with pytest.raises(InputError, match="start posture"):
        LioStation(load_scenario("relocation"), q0=q0)


def test_drive_ramps_the_gripper_and_holds_what_is_not_finite():
    drive = LioDrive(START_POSTURE)
    simulator = Simulator(drive)
    context = simulator.get_mutable_context()
    wanted = drive.GetInputPort("desired_state").FixValue(context, np.concatenate([START_POSTURE + 0.1, np.ones(6)]))
    drive.GetInputPort("gripper_command").FixValue(context, [1.0])
    simulator.AdvanceTo(0.105)
    out = drive.GetOutputPort("actuator_state").Eval(context)
    assert out[:6] == pytest.approx(START_POSTURE + 0.1)
    assert out[6] == pytest.approx(OPEN_ANGLE - 6 * 0.02 * GRIPPER_SPEED)
    wanted.GetMutableData().set_value(np.full(12, np.nan))
    simulator.AdvanceTo(2.0)
    out = drive.GetOutputPort("actuator_state").Eval(context)
    assert out == pytest.approx([*(START_POSTURE + 0.1), CLOSE_TARGET, *np.zeros(7)])


def test_pose_vectors_round_trip():
    vector = np.array([0.1, -0.2, 0.3, 0.5, 0.5, -0.5, 0.5])
    assert pose_to_vector(vector_to_pose(2 * vector))[3:] == pytest.approx(vector[3:])
    assert pose_to_vector(vector_to_pose(vector)) == pytest.approx(vector)
