"""The gripper's camera: it shows the station as it is, to who looks, and to nobody else."""

import io

import numpy as np
import pytest
from PIL import Image
from pydrake.systems.framework import DiagramBuilder

from diagrams.scenario import load_scenario
from diagrams.station.lio_station import LioStation
from diagrams.view import gripper_camera
from diagrams.view.gripper_camera import SIZE, GripperCamera, can_render

pytestmark = pytest.mark.skipif(not can_render(), reason="needs libEGL")
OVER_BASKET = (-0.81, -0.2, 1.24, 0.09, 1.37, -0.11)
"""[rad]"""


class Watcher:
    wanted = True

    def __init__(self):
        self.pictures = []

    def picture_wanted(self):
        return self.wanted

    def show_picture(self, jpeg):
        self.pictures.append(jpeg)


@pytest.fixture(scope="module")
def looked_at():
    world, builder = load_scenario("laundry"), DiagramBuilder()
    station = LioStation.AddToBuilder(builder=builder, world=world)
    watcher = Watcher()
    diagram = builder.Build()
    return station, diagram, watcher, GripperCamera(station, world, 0, watcher)


def put(station, root, **changes):
    """The arm over the basket, or elsewhere; items shifted."""
    context = station.plant.GetMyMutableContextFromRoot(root)
    q = station.plant.GetPositions(context)
    q[:6] = changes.get("arm", OVER_BASKET)
    station.plant.SetPositions(context, q)
    for k in range(1, context.num_discrete_state_groups()):
        values = context.get_mutable_discrete_state(k).get_mutable_value()
        values[: len(values) // 3 : 3] += changes.get("items", 0.0)


def test_it_shows_arm_and_deformable_items_as_they_are(looked_at):
    station, diagram, _, camera = looked_at
    root = diagram.CreateDefaultContext()
    put(station, root)
    here = camera.picture(root).astype(int)
    assert here.shape == (SIZE[1], SIZE[0], 3)
    assert np.array_equal(here, camera.picture(root)), "nothing moved"
    put(station, root, items=0.1)
    assert (np.abs(camera.picture(root) - here).max(axis=2) > 40).sum() > 60, "cloth that moved is seen to"
    put(station, root, arm=(-0.6, *OVER_BASKET[1:]))
    assert (np.abs(camera.picture(root) - here).max(axis=2) > 40).mean() > 0.1


def test_it_renders_for_who_looks_and_for_nobody_else(looked_at, monkeypatch):
    _, diagram, watcher, camera = looked_at
    root = diagram.CreateDefaultContext()
    clock = iter([0.0, 1.0, 1.05, 1.1, 1.12, 3.0, 3.2])
    monkeypatch.setattr(gripper_camera.time, "perf_counter", lambda: next(clock))
    watcher.wanted = False
    camera.look(root)  # at 0
    assert not watcher.pictures
    watcher.wanted = True
    camera.look(root)  # at 1, took 0.05
    assert len(watcher.pictures) == 1
    assert Image.open(io.BytesIO(watcher.pictures[0])).size == SIZE
    camera.look(root)  # at 1.1: too soon
    camera.look(root)  # at 1.12
    assert len(watcher.pictures) == 1
    camera.look(root)  # at 3, took 0.2: a quarter of the time at most
    assert len(watcher.pictures) == 2
    assert camera._next == pytest.approx(3.8)
