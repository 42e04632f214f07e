"""Rigid pieces rest where they lie, hold what falls on them, and wake before they are touched."""

import numpy as np
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.analysis import Simulator

from diagrams.lio_station import START_POSTURE, LioStation
from diagrams.rest import Rest
from diagrams.scenario import load_scenario, with_items


def station_at_rest(seconds: float):
    station = LioStation(with_items(load_scenario("laundry"), "rigid"))
    rest = Rest(
        plant=station.plant,
        scene_graph=station.scene_graph,
        robot=station.scene.lio,
        items=station.scene.items,
    )
    simulator = Simulator(station)
    context = simulator.get_mutable_context()
    station.GetInputPort("desired_state").FixValue(context, np.concatenate([START_POSTURE, np.zeros(6)]))
    station.GetInputPort("gripper_command").FixValue(context, [0.0])
    simulator.set_monitor(rest)
    simulator.AdvanceTo(seconds)
    return station, rest, simulator


def locked(station, simulator) -> list[bool]:
    context = station.plant_context(simulator.get_context())
    return [item.body.is_locked(context) for item in station.scene.rigid_items]


def test_settled_pieces_rest_where_they_came_to_rest():
    station, _, simulator = station_at_rest(3.0)
    assert all(locked(station, simulator))
    before = station.GetOutputPort("item_poses").Eval(simulator.get_context()).copy()
    simulator.AdvanceTo(4.0)
    np.testing.assert_array_equal(station.GetOutputPort("item_poses").Eval(simulator.get_context()), before)


def put_above(station, rest, simulator, height: float):
    """The second piece, awake, `height` [m] above the first, falling; plant, context, the first and the second."""
    plant = station.plant
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    below, above, _ = station.scene.rigid_items
    rest.set_awake(simulator.get_mutable_context(), np.array([False, True, False]))
    pose = plant.EvalBodyPoseInWorld(context, above.body)
    pose.set_translation(plant.EvalBodyPoseInWorld(context, below.body).translation() + [0, 0, height])
    plant.SetFreeBodyPose(context, above.body, pose)
    plant.SetFreeBodySpatialVelocity(context, above.body, SpatialVelocity(w=np.zeros(3), v=np.array([0, 0, -0.5])))
    return plant, context, below, above


def test_a_resting_piece_holds_what_falls_on_it():
    station, rest, simulator = station_at_rest(3.0)
    plant, context, below, above = put_above(station, rest, simulator, 0.12)
    assert rest.awake(context).tolist() == [False, True, False]
    before = plant.EvalBodyPoseInWorld(context, below.body).translation().copy()
    lowest = np.inf
    for _ in range(30):
        simulator.AdvanceTo(simulator.get_context().get_time() + 0.01)
        lowest = min(lowest, plant.EvalBodyPoseInWorld(context, above.body).translation()[2] - before[2])
    np.testing.assert_array_equal(plant.EvalBodyPoseInWorld(context, below.body).translation(), before)
    assert lowest > 0.04, "both are some 5 cm thick"


def test_what_moves_below_a_resting_piece_wakes_it():
    station, rest, simulator = station_at_rest(3.0)
    _, context, below, _above = put_above(station, rest, simulator, 0.06)
    simulator.AdvanceTo(3.4)
    rest.set_awake(simulator.get_mutable_context(), np.array([True, False, False]))
    simulator.AdvanceTo(3.41)
    moving = SpatialVelocity(w=np.zeros(3), v=np.array([0.1, 0, 0]))
    station.plant.SetFreeBodySpatialVelocity(context, below.body, moving)
    assert rest.awake(context).tolist() == [True, True, False]


def test_the_robot_near_a_piece_keeps_it_awake():
    station, rest, simulator = station_at_rest(3.0)
    plant = station.plant
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    item = station.scene.rigid_items[0]
    pose = plant.EvalBodyPoseInWorld(context, item.body)
    tcp = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName("tcp", station.scene.lio))
    pose.set_translation(tcp.translation())
    item.body.Unlock(context)
    plant.SetFreeBodyPose(context, item.body, pose)
    assert rest.awake(context)[0]
    assert not rest.awake(context)[2]
