"""Lets pieces rest: what lies still, with nothing near that moves, is not simulated until something comes near.

A resting soft piece is disabled in the plant (`DeformableModel.Disable`), a resting rigid one is locked
(`RigidBody.Lock`), and contacts of either are no longer looked for: it stays where it is, and costs nothing (a step of
three resting soft pieces: 3.9 ms awake, 0.3 ms asleep). It wakes *before* anything touches it, so that no contact is
missed. Which pieces rest is a parameter of the plant and of the scene graph in the Context; nothing is kept here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from pydrake.geometry import CollisionFilterDeclaration, GeometryId, GeometrySet, Role, SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import Context, EventStatus

from diagrams.scene import RigidItem
from diagrams.shape_bounds import BodyBounds, extent
from diagrams.soft_items import SoftItem, soft_positions, soft_velocities

PERIOD = 0.02  # [s]
SETTLING = 0.5  # [s]: at the start everything hangs in the air with no speed
STILL = 0.003  # [m/s], of the fastest node; settled piles creep at 0.0001
UNMOVED = 0.05  # [m/s²]: where a rocking bundle turns it has no speed either, but 0.1 and more of this
NEAR = 0.012  # [m] between bounds; what moves may come nearer than this by two periods of its speed
ROBOT_NEAR = 0.025  # [m], between bounds: at 1 m/s the robot needs more than a period for this
# Bounds of a soft piece are those of each triangle of its surface: a long one that lies aslant has a large box around
# it, and would be woken by what only passes.


class _Piece(Protocol):
    """What rest needs to know of a piece, and do to it."""

    @property
    def geometry_ids(self) -> list[GeometryId]: ...

    def speed(self, context: Context, size: float) -> float:
        """Of its fastest point [m/s], at most `size` [m] from its middle; infinite where it stands still only for a
        moment."""
        ...

    def is_awake(self, context: Context) -> bool: ...

    def wake(self, context: Context, awake: bool) -> None: ...


@dataclass(frozen=True)
class _SoftPiece:
    plant: MultibodyPlant
    item: SoftItem

    @property
    def geometry_ids(self) -> list[GeometryId]:
        return [self.item.geometry_id]

    def speed(self, context: Context, size: float) -> float:
        return float(np.sqrt((soft_velocities(self.plant, context, self.item) ** 2).sum(axis=1).max()))

    def is_awake(self, context: Context) -> bool:
        return self.plant.deformable_model().is_enabled(self.item.body_id, context)

    def wake(self, context: Context, awake: bool) -> None:
        model = self.plant.deformable_model()
        (model.Enable if awake else model.Disable)(self.item.body_id, context)


@dataclass(frozen=True)
class _RigidPiece:
    plant: MultibodyPlant
    item: RigidItem

    @property
    def geometry_ids(self) -> list[GeometryId]:
        return self.plant.GetCollisionGeometriesForBody(self.item.body)

    def speed(self, context: Context, size: float) -> float:
        if not self.is_awake(context):
            return 0.0
        V = self.plant.EvalBodySpatialVelocityInWorld(context, self.item.body)
        speed = float(np.linalg.norm(V.translational()) + np.linalg.norm(V.rotational()) * size)
        if speed > STILL:
            return speed
        A = self.plant.EvalBodySpatialAccelerationInWorld(context, self.item.body)
        turning = np.linalg.norm(A.translational()) + np.linalg.norm(A.rotational()) * size
        return float("inf") if turning > UNMOVED else speed

    def is_awake(self, context: Context) -> bool:
        return not self.item.body.is_locked(context)

    def wake(self, context: Context, awake: bool) -> None:
        (self.item.body.Unlock if awake else self.item.body.Lock)(context)


class Rest:
    """A monitor for Drake's Simulator: puts the pieces of a plant to rest and wakes them, every 20 ms.

    A piece is awake when it moves, when the robot is near it, or when it is near such a piece.
    """

    def __init__(
        self,
        *,
        plant: MultibodyPlant,
        scene_graph: SceneGraph,
        robot: ModelInstanceIndex,
        items: Sequence[RigidItem | SoftItem],
    ) -> None:
        self._plant = plant
        self._scene_graph = scene_graph
        self._pieces: list[_Piece] = [
            _SoftPiece(plant, item) if isinstance(item, SoftItem) else _RigidPiece(plant, item) for item in items
        ]
        inspector = scene_graph.model_inspector()
        self._everything = inspector.GetAllGeometryIds(Role.kProximity)
        # Of links and rigid pieces at once, since one body at a time took a fifth of a run.
        links = {}
        for index in plant.GetBodyIndices(robot):
            body = plant.get_body(index)
            shapes = [extent(inspector, g) for g in plant.GetCollisionGeometriesForBody(body)]
            extents = [shape for shape in shapes if shape is not None]
            if extents:
                links[body] = extents
        self._n_links = len(links)
        self._rigid = [k for k, item in enumerate(items) if isinstance(item, RigidItem)]
        self._soft = [
            (k, item, item.shape.mesh.boundary()) for k, item in enumerate(items) if isinstance(item, SoftItem)
        ]
        rigid_items = [item for item in items if isinstance(item, RigidItem)]
        self._bodies = [*links, *(item.body for item in rigid_items)]
        self._bounds = BodyBounds([*links.values(), *(item.extents for item in rigid_items)])

    def __call__(self, root_context: Context) -> EventStatus:
        """Look, if it is time to; `root_context` belongs to the diagram that the plant is in."""
        step = round(root_context.get_time() / self._plant.time_step())
        if root_context.get_time() < SETTLING or step % max(1, round(PERIOD / self._plant.time_step())):
            return EventStatus.DidNothing()
        context = self._plant.GetMyMutableContextFromRoot(root_context)
        for piece, awake in zip(self._pieces, self.awake(context), strict=True):
            if awake != piece.is_awake(context):
                piece.wake(context, bool(awake))
                self._look_for_contact(root_context, piece, bool(awake))
        return EventStatus.Succeeded()

    def _look_for_contact(self, root_context: Context, piece: _Piece, wanted: bool) -> None:
        filters = self._scene_graph.collision_filter_manager(
            self._scene_graph.GetMyMutableContextFromRoot(root_context)
        )
        own, others = GeometrySet(piece.geometry_ids), GeometrySet(self._everything)
        declaration = CollisionFilterDeclaration()
        filters.Apply(declaration.AllowBetween(own, others) if wanted else declaration.ExcludeBetween(own, others))

    def awake(self, context: Context) -> np.ndarray:
        """Which pieces are to be simulated, given the plant's context. Shape (n,), bool."""
        bounds = self._bounds([self._plant.EvalBodyPoseInWorld(context, body) for body in self._bodies])
        links, pieces = bounds[: self._n_links], np.empty((len(self._pieces), 6))
        pieces[self._rigid] = bounds[self._n_links :]
        parts = {k: pieces[k : k + 1] for k in self._rigid}
        for k, item, triangles in self._soft:
            nodes = soft_positions(self._plant, context, item)
            corners = nodes[triangles]
            parts[k] = np.hstack([corners.min(axis=1), corners.max(axis=1)])
            pieces[k] = (*nodes.min(axis=0), *nodes.max(axis=0))
        sizes = np.linalg.norm(pieces[:, 3:] - pieces[:, :3], axis=1) / 2
        speed = np.array([p.speed(context, size) for p, size in zip(self._pieces, sizes, strict=True)])
        touched = _gaps(pieces, links) < ROBOT_NEAR
        for k, *_ in self._soft:
            if touched[k].any():
                touched[k] = (_gaps(parts[k], links) < ROBOT_NEAR).any(axis=0)
        active = (speed > STILL) | touched.any(axis=1)
        reach = NEAR + 2.0 * PERIOD * np.where(np.isfinite(speed), speed, 0.0)
        reach = np.maximum(reach[:, None], reach[None, :])
        near = _gaps(pieces, pieces) < reach
        for i, *_ in self._soft:
            for j in np.flatnonzero(near[i]).tolist():
                near[i, j] = near[j, i] = i == j or (_gaps(parts[i], parts[j]) < reach[i, j]).any()
        return active | (near & active[None, :]).any(axis=1)


def _gaps(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Largest gap along an axis between bounds (n, 6) and (m, 6) [m]; negative where they overlap. Shape (n, m)."""
    return np.maximum(a[:, None, :3] - b[None, :, 3:], b[None, :, :3] - a[:, None, 3:]).max(axis=2)
