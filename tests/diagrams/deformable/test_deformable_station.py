"""The Lio station with deformable clothes: the same ports, honest numbers."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from diagrams.deformable.items import deformable_positions
from diagrams.scenario import load_scenario, with_items
from diagrams.station.lio_station import START_POSTURE, LioStation


@pytest.fixture(scope="module")
def settled():
    """Station and context after the clothes have settled in the basket."""
    station = LioStation(with_items(load_scenario("laundry"), "soft"), seed=3)
    context = station.CreateDefaultContext()
    station.GetInputPort("desired_state").FixValue(context, np.concatenate([START_POSTURE, np.zeros(6)]))
    station.GetInputPort("gripper_command").FixValue(context, [0.0])
    simulator = Simulator(station, context)
    simulator.AdvanceTo(0.8)
    return station, context


def test_ports_agree_with_the_nodes(settled):
    station, context = settled
    items = station.scene.deformable_items
    poses = station.GetOutputPort("item_poses").Eval(context).reshape(-1, 7)
    bounds = station.GetOutputPort("item_bounds").Eval(context).reshape(-1, 6)
    assert len(items) == len(poses) == 3
    for item, pose, box in zip(items, poses, bounds, strict=True):
        nodes = deformable_positions(station.plant, station.plant_context(context), item)
        np.testing.assert_allclose(pose, [*nodes.mean(axis=0), 1, 0, 0, 0], atol=1e-12)
        np.testing.assert_allclose(box, [*nodes.min(axis=0), *nodes.max(axis=0)], atol=1e-12)


def test_clothes_lie_in_the_basket_and_neither_creep_nor_leak(settled):
    station, context = settled
    bounds = station.GetOutputPort("item_bounds").Eval(context).reshape(-1, 6)
    assert bounds[:, 2].min() > 0.31 - 0.001  # the basket's floor
    assert bounds[:, 5].max() < 0.42
    assert station.GetOutputPort("item_speeds").Eval(context).max() < 1e-3
    assert station.GetOutputPort("penetration").Eval(context)[0] < 0.002


def test_clothes_lie_apart(settled):
    station, context = settled
    clouds = [
        deformable_positions(station.plant, station.plant_context(context), item)
        for item in station.scene.deformable_items
    ]
    in_base = [station.X_WB.inverse().multiply(cloud.T) for cloud in clouds]  # the basket stands along its axes
    for i in range(3):
        for j in range(i):
            one, two = in_base[i], in_base[j]
            overlap = np.minimum(one.max(axis=1), two.max(axis=1)) - np.maximum(one.min(axis=1), two.min(axis=1))
            assert overlap.min() < 0.03
