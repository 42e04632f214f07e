"""The Lio station: its ports, its controllers, its contact; cheap ones."""

import numpy as np
import pytest
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import EventStatus
from tables import high_table

from canal.errors import InputError
from diagrams.geometry.pose_vector import pose_to_vector
from diagrams.scenario import load_scenario
from diagrams.station.lio_drive import CLOSE_TARGET, GRIPPER_SPEED, OPEN_ANGLE, LioDrive
from diagrams.station.lio_station import START_POSTURE, LioStation

PORTS = {
    "q": 6, "v": 6, "gripper_state": 2, "X_BT": 7, "item_poses": 21, "item_bounds": 18, "item_speeds": 3,
    "contact_forces": 4, "penetration": 1,
}  # fmt: skip
SPEED = np.deg2rad(95.0)
"""[rad/s] Of every joint of the arm (docs/method.md, 6)."""
RATE = 60
"""[Hz] Of commands, and of the rig's scenario."""


class Rig:
    """A station alone, its inputs in hand."""

    def __init__(self, name="laundry", seed=0, q0=START_POSTURE, change=None):
        scenario = load_scenario(name)
        for item in scenario.items:
            item.kind = "rigid"
        scenario.control_rate_hz = RATE
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
        """Command a motion at the control rate; returns the largest lag [rad] and all joint speeds [rad/s]."""
        begin, worst, speeds = self.context.get_time(), 0.0, []
        self.simulator.set_monitor(lambda root: (speeds.append(self["v"].copy()), EventStatus.Succeeded())[1])
        for k in range(1, round(RATE * seconds) + 1):
            # A command comes with the tick's update, so that the step at the tick itself still follows the last one.
            self.simulator.AdvanceTo(begin + (k - 1) / RATE + 1e-6)
            q, v = q_of_t(k / RATE), (q_of_t(k / RATE) - q_of_t((k - 1) / RATE)) * RATE
            self.wanted.GetMutableData().set_value(np.concatenate([q, v]))
            self.simulator.AdvanceTo(begin + k / RATE)
            worst = max(worst, np.abs(self["q"] - q).max())
        self.simulator.clear_monitor()
        return worst, np.array(speeds)


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
    laundry.run(1.5)  # the bundles lean over first, each in its own time
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
    lag, _ = rig.follow(lambda t: START_POSTURE + swing * (1 - np.cos(np.pi * t)) / 2, 1.0)
    assert lag < 0.01


def test_a_steady_speed_is_steady():
    """Between two commands the joints do not swing about the speed that is wanted."""
    rig = Rig(change=lambda s: s.items.__delitem__(slice(1, None)))
    speed = np.array([0.5, 0.5, -0.5, 0.5, -0.5, 0.5])
    _, speeds = rig.follow(lambda t: START_POSTURE + speed * t, 0.6)
    np.testing.assert_allclose(speeds[-50:], np.tile(speed, (50, 1)), rtol=0.01)


@pytest.mark.parametrize("how", ["all start and stop", "shoulder turns back", "elbow turns back"])
def test_no_joint_exceeds_its_speed_when_full_speed_is_commanded(how):
    """From rest to full speed and back, or from full speed to the other way, from one command to the next."""
    rig = Rig(change=lambda s: s.items.__delitem__(slice(1, None)))
    if how == "all start and stop":
        directions = np.outer((np.arange(40) > 3) & (np.arange(40) < 15), [1.0, -1, 1, -1, 1, 1])
    else:
        joint = 1 if how == "shoulder turns back" else 2
        directions = np.outer(np.where(np.arange(40) // 10 % 2, 1.0, -1.0), np.eye(6)[joint])
    ticks = START_POSTURE + SPEED / RATE * np.vstack([np.zeros(6), np.cumsum(directions, axis=0)])
    _, speeds = rig.follow(lambda t: ticks[round(t * RATE)], 0.6)
    assert 0.9 * SPEED < np.abs(speeds).max() <= SPEED


def test_a_touch_is_felt():
    """The hand presses on the table in front of it: the pair that is touched feels it, the others do not."""
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
    drive = LioDrive(START_POSTURE, period=0.02, time_step=0.004)
    simulator = Simulator(drive)
    context = simulator.get_mutable_context()
    wanted = drive.GetInputPort("desired_state").FixValue(context, np.concatenate([START_POSTURE + 0.1, np.ones(6)]))
    drive.GetInputPort("gripper_command").FixValue(context, [1.0])
    drive.GetInputPort("lio_state").FixValue(context, np.zeros(16))
    simulator.AdvanceTo(0.105)
    out = drive.GetOutputPort("actuator_state").Eval(context)
    # 0.015 s before the end of the command's period, on the straight line to it.
    assert out[:6] == pytest.approx(START_POSTURE + 0.1 - 0.015)
    assert out[6] == pytest.approx(OPEN_ANGLE - 0.105 * GRIPPER_SPEED)
    wanted.GetMutableData().set_value(np.full(12, np.nan))
    simulator.AdvanceTo(2.0)
    out = drive.GetOutputPort("actuator_state").Eval(context)
    assert out == pytest.approx([*(START_POSTURE + 0.1), CLOSE_TARGET, *np.zeros(7)])


def test_a_pose_becomes_position_and_quaternion():
    vector = np.array([0.1, -0.2, 0.3, 0.5, 0.5, -0.5, 0.5])
    assert pose_to_vector(RigidTransform(Quaternion(vector[3:]), vector[:3])) == pytest.approx(vector)
