"""Rigid items sleep where they lie, hold what falls on them, and wake before they are touched."""

from collections.abc import Callable

import numpy as np
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.analysis import Simulator
from tables import high_table

from diagrams.scenario import Scenario, load_scenario, with_items
from diagrams.station.lio_drive import LioDrive
from diagrams.station.lio_station import START_POSTURE, LioStation
from diagrams.station.sleep import sleep_manager


def as_shipped(scenario: Scenario) -> None:
    """No change."""


def station_asleep(seconds: float, change: Callable[[Scenario], None] = as_shipped, *, arm: bool = False):
    """Rigid laundry after so many seconds [s]; with `arm`, the arm may sleep, too. Its manager, simulator, inputs."""
    scenario = with_items(load_scenario("laundry"), "rigid")
    change(scenario)
    station = LioStation(scenario)
    sleep = sleep_manager(station, arm=arm)
    simulator = Simulator(station)
    context = simulator.get_mutable_context()
    wanted = station.GetInputPort("desired_state").FixValue(context, np.concatenate([START_POSTURE, np.zeros(6)]))
    gripper = station.GetInputPort("gripper_command").FixValue(context, [0.0])
    simulator.set_monitor(sleep)
    simulator.AdvanceTo(seconds)
    return station, sleep, simulator, wanted, gripper


def locked(station, simulator) -> list[bool]:
    context = station.plant_context(simulator.get_context())
    return [item.body.is_locked(context) for item in station.scene.rigid_items]


def test_settled_items_sleep_where_they_came_to_rest():
    station, _, simulator, *_ = station_asleep(3.0)
    assert all(locked(station, simulator))
    before = station.GetOutputPort("item_poses").Eval(simulator.get_context()).copy()
    simulator.AdvanceTo(4.0)
    np.testing.assert_array_equal(station.GetOutputPort("item_poses").Eval(simulator.get_context()), before)


def put_above(station, sleep, simulator, height: float):
    """The second item, awake, `height` [m] above the first, falling; plant, context, the first and the second."""
    plant = station.plant
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    below, above, _ = station.scene.rigid_items
    sleep.set_awake(simulator.get_mutable_context(), np.array([False, True, False]))
    pose = plant.EvalBodyPoseInWorld(context, above.body)
    pose.set_translation(plant.EvalBodyPoseInWorld(context, below.body).translation() + [0, 0, height])
    plant.SetFreeBodyPose(context, above.body, pose)
    plant.SetFreeBodySpatialVelocity(context, above.body, SpatialVelocity(w=np.zeros(3), v=np.array([0, 0, -0.5])))
    return plant, context, below, above


def test_a_sleeping_item_holds_what_falls_on_it():
    station, sleep, simulator, *_ = station_asleep(3.0)
    plant, context, below, above = put_above(station, sleep, simulator, 0.12)
    assert sleep.awake(context).tolist() == [False, True, False]
    before = plant.EvalBodyPoseInWorld(context, below.body).translation().copy()
    lowest = np.inf
    for _ in range(30):
        simulator.AdvanceTo(simulator.get_context().get_time() + 0.01)
        lowest = min(lowest, plant.EvalBodyPoseInWorld(context, above.body).translation()[2] - before[2])
    np.testing.assert_array_equal(plant.EvalBodyPoseInWorld(context, below.body).translation(), before)
    assert lowest > 0.04, "both are some 5 cm thick"


def test_what_moves_below_a_sleeping_item_wakes_it():
    station, sleep, simulator, *_ = station_asleep(3.0)
    _, context, below, _above = put_above(station, sleep, simulator, 0.06)
    simulator.AdvanceTo(3.4)
    sleep.set_awake(simulator.get_mutable_context(), np.array([True, False, False]))
    simulator.AdvanceTo(3.41)
    moving = SpatialVelocity(w=np.zeros(3), v=np.array([0.1, 0, 0]))
    station.plant.SetFreeBodySpatialVelocity(context, below.body, moving)
    assert sleep.awake(context).tolist() == [True, True, False]


def test_the_robot_near_an_item_keeps_it_awake():
    station, sleep, simulator, *_ = station_asleep(3.0)
    plant = station.plant
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    item = station.scene.rigid_items[0]
    pose = plant.EvalBodyPoseInWorld(context, item.body)
    tcp = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName("tcp", station.scene.lio))
    pose.set_translation(tcp.translation())
    item.body.Unlock(context)
    plant.SetFreeBodyPose(context, item.body, pose)
    assert sleep.awake(context)[0]
    assert not sleep.awake(context)[2]


def joints_locked(station, simulator) -> list[bool]:
    context = station.plant_context(simulator.get_context())
    joints = [station.plant.get_joint(j) for j in station.plant.GetJointIndices(station.scene.lio)]
    return [joint.is_locked(context) for joint in joints if joint.num_velocities()]


def measured(station, simulator, name) -> np.ndarray:
    return station.GetOutputPort(name).Eval(simulator.get_context()).copy()


def test_an_arm_that_stands_sleeps_and_moves_at_the_first_command_without_a_jump():
    station, _, simulator, wanted, gripper = station_asleep(1.5, arm=True)
    assert all(joints_locked(station, simulator))
    assert all(locked(station, simulator))
    before = measured(station, simulator, "q")
    simulator.AdvanceTo(3.0)
    np.testing.assert_array_equal(measured(station, simulator, "q"), before)
    step = np.array([0.02, 0.0, 0.0, 0.0, 0.0, 0.0])
    last = before
    for tick in range(1, 26):
        wanted.GetMutableData().set_value(np.concatenate([START_POSTURE + tick * 0.1 * step, step / 0.2]))
        simulator.AdvanceTo(3.0 + 0.02 * tick)
        now = measured(station, simulator, "q")
        assert np.abs(now - last).max() < 0.004, "no more than the command moves"
        last = now
    assert not any(joints_locked(station, simulator))
    assert last[0] - before[0] > 0.04
    wanted.GetMutableData().set_value(np.concatenate([START_POSTURE + 2.5 * step, np.zeros(6)]))
    simulator.AdvanceTo(5.0)
    assert all(joints_locked(station, simulator))
    gripper.GetMutableData().set_value([1.0])
    simulator.AdvanceTo(5.3)
    assert measured(station, simulator, "gripper_state")[0] < 0.4
    assert not any(joints_locked(station, simulator))


def test_what_a_sleeping_arm_presses_on_is_pressed_on():
    """Drake computes no force between what is locked: an alarm would vanish, and come back."""
    station, _, simulator, wanted, _ = station_asleep(0.1, high_table, arm=True)
    down = np.array([0, 0.0, 0.35, 0, 0.25, 0])
    for tick in range(1, 41):
        wanted.GetMutableData().set_value(np.concatenate([START_POSTURE + 0.02 * tick * down, down]))
        simulator.AdvanceTo(0.1 + 0.02 * tick)
    wanted.GetMutableData().set_value(np.concatenate([START_POSTURE + 0.8 * down, np.zeros(6)]))
    simulator.AdvanceTo(3.0)
    assert all(joints_locked(station, simulator))
    pressed = measured(station, simulator, "contact_forces")
    assert pressed[1] > 100.0
    simulator.AdvanceTo(4.0)
    np.testing.assert_array_equal(measured(station, simulator, "contact_forces"), pressed)
    q = measured(station, simulator, "q")
    wanted.GetMutableData().set_value(np.concatenate([START_POSTURE + 0.7999 * down, np.zeros(6)]))
    for tick in range(1, 21):
        simulator.AdvanceTo(4.0 + 0.004 * tick)
        np.testing.assert_allclose(measured(station, simulator, "contact_forces"), pressed, rtol=0.03)
    assert not any(joints_locked(station, simulator))
    np.testing.assert_allclose(measured(station, simulator, "q"), q, atol=2e-4)


def test_an_item_that_moves_beside_a_sleeping_arm_wakes_it():
    station, sleep, simulator, *_ = station_asleep(1.5, arm=True)
    plant = station.plant
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    item = station.scene.rigid_items[0]
    pose = plant.EvalBodyPoseInWorld(context, item.body)
    tcp = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName("tcp", station.scene.lio))
    pose.set_translation(tcp.translation() + [0, 0, 0.15])
    sleep.set_awake(root, np.array([True, False, False]), arm=False)
    plant.SetFreeBodyPose(context, item.body, pose)
    simulator.AdvanceTo(1.55)
    assert joints_locked(station, simulator) == [True] * 8, "it falls, and is not there yet"
    simulator.AdvanceTo(1.66)
    assert joints_locked(station, simulator) == [False] * 8


def test_the_drives_of_a_sleeping_arm_are_not_asked(monkeypatch):
    """Their command follows what they are told, which changes with no step of the plant but once a tick."""
    asked = []
    monkeypatch.setattr(LioDrive, "_calc", lambda *arguments, calc=LioDrive._calc: asked.append(0) or calc(*arguments))
    station, _, simulator, wanted, _ = station_asleep(1.5, arm=True)
    assert all(joints_locked(station, simulator))
    before = len(asked)
    assert before
    simulator.AdvanceTo(2.5)
    assert len(asked) == before
    wanted.GetMutableData().set_value(np.concatenate([START_POSTURE + 0.01, np.zeros(6)]))
    simulator.AdvanceTo(2.6)
    assert len(asked) > before + 10, "at each step of the plant"
