"""Rigid pieces rest when nothing is near, wake before they are touched, and rest changes nothing that is seen."""

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


def test_a_piece_that_falls_wakes_the_one_beneath_before_it_lands():
    station, rest, simulator = station_at_rest(3.0)
    plant = station.plant
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    below, above, elsewhere = station.scene.rigid_items
    above.body.Unlock(context)
    pose = plant.EvalBodyPoseInWorld(context, above.body)
    beneath = plant.EvalBodyPoseInWorld(context, below.body).translation()
    pose.set_translation(beneath + [0, 0, 0.12])
    plant.SetFreeBodyPose(context, above.body, pose)
    falling = SpatialVelocity(w=np.zeros(3), v=np.array([0, 0, -1.5]))
    plant.SetFreeBodySpatialVelocity(context, above.body, falling)
    assert rest.awake(context).tolist() == [True, True, False], (below.name, above.name, elsewhere.name)


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
