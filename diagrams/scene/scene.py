"""The scene of a scenario: robot, fixtures, items and marks in a MultibodyPlant, before it is finalized."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from pydrake.geometry import Cylinder, SceneGraph
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import BodyIndex, ModelInstanceIndex, RigidBody

from diagrams.deformable.items import DeformableItem, add_deformable_item
from diagrams.deformable.laundry import make_shape
from diagrams.geometry.bounds import BodyBounds, Extent, extent
from diagrams.scene.layout import Spot, base_pose, draw_layout, yaw_pose
from diagrams.scene.world import Fixture, Item, Robot, World
from models import BASE_FRAME, LIO_URDF, MODELS

DROP = 0.001
"""Items start this far above their surface [m], and settle."""
MARK_RADIUS = 0.045
MARK_COLORS = {"apple": (0.83, 0.14, 0.13), "cup": (0.05, 0.55, 0.60), "cube": (0.95, 0.68, 0.18)}
"""A mark wears the colour of its item."""


@dataclass(frozen=True)
class RigidItem:
    """An item that is one rigid body.

    It is named by its index: a `RigidBody` in Python keeps its plant alive where the garbage collector cannot see it,
    and a system that held one would keep itself, its diagram and all of the plant's memory for ever.
    """

    name: str
    """As in the scenario."""
    plant: MultibodyPlant
    index: BodyIndex
    extents: list[Extent]
    """Of its collision shapes, for its bounds."""

    @property
    def body(self) -> RigidBody:
        """The body; not to be kept by what is part of the diagram."""
        return self.plant.get_body(self.index)


@dataclass
class Scene:
    """Handles to what was added to the plant."""

    world: World
    lio: ModelInstanceIndex
    X_WB: RigidTransform
    fixtures: dict[str, list[ModelInstanceIndex]] = field(default_factory=dict)
    """By name; fixtures that share a name are watched as one."""
    items: list[RigidItem | DeformableItem] = field(default_factory=list)
    """In the order of the world."""
    marks: list[Spot | None] = field(default_factory=list)
    rest_heights: list[float] = field(default_factory=list)
    """Of each item's origin above the surface it stands on [m]."""

    @property
    def rigid_items(self) -> list[RigidItem]:
        """Those that are rigid bodies."""
        return [item for item in self.items if isinstance(item, RigidItem)]

    @property
    def deformable_items(self) -> list[DeformableItem]:
        """Those that are deformable."""
        return [item for item in self.items if isinstance(item, DeformableItem)]


def add_lio(plant: MultibodyPlant, robot: Robot) -> tuple[ModelInstanceIndex, RigidTransform]:
    """Parse the Lio and weld its base; returns its model and X_WB.

    Args:
        plant: before it is finalized.
        robot: where it stands.
    """
    X_WB = base_pose(robot)
    (lio,) = Parser(plant).AddModels(str(LIO_URDF))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(BASE_FRAME, lio), X_WB)
    return lio, X_WB


def add_scene(
    *, plant: MultibodyPlant, scene_graph: SceneGraph, world: World, seed: int, filmed: bool = False
) -> Scene:
    """Add all that a scenario names to a plant that is registered with a scene graph and not yet finalized.

    `filmed`: whether cameras will look at it.

    Args:
        plant: before it is finalized.
        scene_graph: that the plant is registered with.
        world: what stands where.
        seed: of where the items lie.
        filmed: whether cameras will look at it.

    Raises:
        InputError: a model does not exist, or the items do not fit where they may lie.
    """
    lio, X_WB = add_lio(plant, world.robot)
    scene = Scene(world, lio, X_WB)
    for k, fixture in enumerate(world.fixtures):
        scene.fixtures.setdefault(fixture.name, []).append(_add_fixture(plant, world, fixture, k))
    starts, scene.marks = draw_layout(world, seed)
    for item, start in zip(world.items, starts, strict=True):
        height, handle = _add_item(plant, scene_graph, world, item, start, filmed)
        scene.rest_heights.append(height)
        scene.items.append(handle)
    for item, mark in zip(world.items, scene.marks, strict=True):
        if mark is not None:
            color = np.array([*MARK_COLORS.get(item.model, (0.3, 0.3, 0.3)), 1.0])
            for name, radius, rgba in (("edge", MARK_RADIUS, color), ("field", 0.8 * MARK_RADIUS, PAPER)):
                X = RigidTransform(mark.position + [0, 0, 0.0004 if name == "edge" else 0.0008])
                disk = Cylinder(radius, 0.0008)
                plant.RegisterVisualGeometry(plant.world_body(), X, disk, f"mark_{item.name}_{name}", rgba)
    return scene


PAPER = np.array([0.97, 0.96, 0.92, 1.0])
"""Colour of the marks."""


def _add_fixture(plant: MultibodyPlant, world: World, fixture: Fixture, k: int) -> ModelInstanceIndex:
    path = world.resolve(fixture.model, MODELS / "world", ".sdf")
    (model,) = Parser(plant, f"fixture{k}").AddModels(str(path))
    (body,) = plant.GetBodyIndices(model)
    X = yaw_pose(fixture.position, np.deg2rad(fixture.yaw_deg))
    plant.WeldFrames(plant.world_frame(), plant.get_body(body).body_frame(), X)
    return model


def _add_item(
    plant: MultibodyPlant, scene_graph: SceneGraph, world: World, item: Item, start: Spot, filmed: bool
) -> tuple[float, RigidItem | DeformableItem]:
    """Add one item where it starts; returns also the height of its origin above what it stands on."""
    X = yaw_pose(start.position, start.yaw)
    if item.kind == "soft":
        shape = make_shape(item.model)
        height = -float(shape.mesh.vertices[:, 2].min())
        X.set_translation(start.position + [0, 0, height + DROP])
        return height, add_deformable_item(plant=plant, name=item.name, shape=shape, X_WP=X, filmed=filmed)
    path = world.resolve(item.model, MODELS / "items", ".sdf")
    (model,) = Parser(plant, f"item_{item.name}").AddModels(str(path))
    (index,) = plant.GetBodyIndices(model)
    body = plant.get_body(index)
    inspector = scene_graph.model_inspector()
    extents = [e for g in plant.GetCollisionGeometriesForBody(body) if (e := extent(inspector, g)) is not None]
    height = -float(BodyBounds([extents])([RigidTransform()])[0, 2])
    X.set_translation(start.position + [0, 0, height + DROP])
    plant.SetDefaultFloatingBaseBodyPose(body, X)
    return height, RigidItem(item.name, plant, index, extents)
