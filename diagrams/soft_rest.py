"""Lets soft pieces rest: what lies still, with nothing near that moves, is not simulated until something comes near.

A resting piece is disabled in the plant (`DeformableModel.Disable`), and its contacts are no longer looked for: its
nodes stay where they are, and it costs nothing (a step of three resting pieces: 3.9 ms awake, 0.3 ms asleep). It is
enabled again *before* anything touches it, so that no contact is missed. Which pieces rest is a parameter of the plant
and of the scene graph in the Context; nothing is kept here.
"""

from __future__ import annotations

import numpy as np
from pydrake.geometry import CollisionFilterDeclaration, GeometrySet, Role, SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import Context, EventStatus

from diagrams.shape_bounds import extent, union_bounds
from diagrams.soft_items import SoftItem, soft_positions, soft_velocities

PERIOD = 0.02  # [s]
SETTLING = 0.5  # [s]: at the start everything hangs in the air with no speed
STILL = 0.003  # [m/s], of the fastest node; settled piles creep at 0.0001
NEAR = 0.012  # [m] between bounds; what moves may come nearer than this by two periods of its speed
ROBOT_NEAR = 0.025  # [m], between bounds: at 1 m/s the robot needs more than a period for this


class SoftRest:
    """A monitor for Drake's Simulator: enables and disables the soft pieces of a plant every 20 ms.

    A piece is awake when one of its nodes moves, when the robot is near it, or when it is near such a piece.
    """

    def __init__(
        self,
        *,
        plant: MultibodyPlant,
        scene_graph: SceneGraph,
        robot: ModelInstanceIndex,
        items: list[SoftItem],
    ) -> None:
        self._plant = plant
        self._scene_graph = scene_graph
        self._items = tuple(items)
        inspector = scene_graph.model_inspector()
        self._everything = inspector.GetAllGeometryIds(Role.kProximity)
        self._links = []
        for index in plant.GetBodyIndices(robot):
            body = plant.get_body(index)
            shapes = [extent(inspector, g) for g in plant.GetCollisionGeometriesForBody(body)]
            extents = [shape for shape in shapes if shape is not None]
            if extents:
                self._links.append((body, extents))

    def __call__(self, root_context: Context) -> EventStatus:
        """Look, if it is time to; `root_context` belongs to the diagram that the plant is in."""
        step = round(root_context.get_time() / self._plant.time_step())
        if root_context.get_time() < SETTLING or step % max(1, round(PERIOD / self._plant.time_step())):
            return EventStatus.DidNothing()
        context = self._plant.GetMyMutableContextFromRoot(root_context)
        model = self._plant.deformable_model()
        for item, awake in zip(self._items, self.awake(context), strict=True):
            if awake != model.is_enabled(item.body_id, context):
                (model.Enable if awake else model.Disable)(item.body_id, context)
                self._look_for_contact(root_context, item, awake)
        return EventStatus.Succeeded()

    def _look_for_contact(self, root_context: Context, item: SoftItem, wanted: bool) -> None:
        filters = self._scene_graph.collision_filter_manager(
            self._scene_graph.GetMyMutableContextFromRoot(root_context)
        )
        own, others = GeometrySet(item.geometry_id), GeometrySet(self._everything)
        declaration = CollisionFilterDeclaration()
        filters.Apply(declaration.AllowBetween(own, others) if wanted else declaration.ExcludeBetween(own, others))

    def awake(self, context: Context) -> np.ndarray:
        """Which pieces are to be simulated, given the plant's context. Shape (n,), bool."""
        nodes = [soft_positions(self._plant, context, item) for item in self._items]
        low, high = np.array([p.min(axis=0) for p in nodes]), np.array([p.max(axis=0) for p in nodes])
        velocities = [soft_velocities(self._plant, context, item) for item in self._items]
        speed = np.array([np.sqrt((v**2).sum(axis=1).max()) for v in velocities])
        active = (speed > STILL) | self._touched_by_robot(context, low, high)
        reach = NEAR + 2.0 * PERIOD * speed
        gap = np.maximum(low[:, None] - high[None, :], low[None, :] - high[:, None]).max(axis=2)
        near = gap < np.maximum(reach[:, None], reach[None, :])
        return active | (near & active[None, :]).any(axis=1)

    def _touched_by_robot(self, context: Context, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        bounds = np.array([union_bounds(e, self._plant.EvalBodyPoseInWorld(context, body)) for body, e in self._links])
        gap = np.maximum(low[:, None] - bounds[None, :, 3:], bounds[None, :, :3] - high[:, None]).max(axis=2)
        return (gap < ROBOT_NEAR).any(axis=1)
