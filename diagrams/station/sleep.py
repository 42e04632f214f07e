"""Lets pieces rest: what lies still, and nothing moves that carries it, is not simulated until something stirs it.

A resting piece stays where it is, is met by others as a fixed solid, and costs nothing (a step of three resting soft
pieces: 3.9 ms awake, 0.3 ms asleep; a sock that falls on a towel: 6.5 ms with the towel awake, 1.9 ms at rest, and it
comes to lie within 4 mm of where it would). It wakes *before* the robot touches it, when what bears it moves, and when
the robot presses something against it; what merely comes to lie on it, or beside it, does not wake it.
The arm rests with all that lies in its hand and about it (see `sleeping_arm`); then it is furniture like any other.
Which pieces rest is a parameter of the plant and of the scene graph in the Context; nothing is kept here.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.geometry import CollisionFilterDeclaration, GeometryId, GeometrySet, Role, SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import Context, EventStatus

from diagrams.deformable.items import SoftItem, soft_positions
from diagrams.geometry.bounds import BodyBoxes, Boxes, extent
from diagrams.geometry.contacts import each_contact
from diagrams.scene.scene import RigidItem
from diagrams.station.lio_station import LioStation
from diagrams.station.sleeping_arm import RestingArm, Standing
from diagrams.station.sleeping_item import STILL, make_piece

PERIOD = 0.02  # [s]
SETTLING = 0.06  # [s]: at the start everything hangs in the air with no speed
NEAR = 0.012  # [m] between bounds; what moves may come nearer than this by two periods of its speed
STILL_ROBOT_NEAR = 0.003  # [m] between bounds, while the robot stands; while it moves, two periods of its speed more,
ROBOT_NEAR = 0.015  # [m] but no more than this: it moves at up to 0.3 m/s
CARRIED = 0.25  # share of a piece's weight: what bears more of it takes it along
PRESSED = 15.0  # [N]: what the robot presses harder against a piece moves it; blows of falling cloth stay below
# Bounds of a soft piece are those of each triangle of its surface: a long one that lies aslant has a large box around
# it, and would be woken by what only passes.


class Rest:
    """A monitor for Drake's Simulator: puts the pieces of a plant to rest and wakes them, every 20 ms."""

    def __init__(
        self,
        *,
        plant: MultibodyPlant,
        scene_graph: SceneGraph,
        robot: ModelInstanceIndex,
        items: Sequence[RigidItem | SoftItem],
        standing: Standing | None = None,
    ) -> None:
        """Watch these.

        Args:
            plant: finalized.
            scene_graph: of the plant.
            robot: what wakes pieces by coming near.
            items: the pieces.
            standing: in the path of the robot's command; None for a robot that never rests.
        """
        self._plant = plant
        self._scene_graph = scene_graph
        self._pieces = [make_piece(plant, scene_graph, item) for item in items]
        self._names = [*(item.name for item in items), "robot"]
        inspector = scene_graph.model_inspector()
        of_pieces = {g for piece in self._pieces for g in (*piece.own, *piece.at_rest)}
        self._others = [g for g in inspector.GetAllGeometryIds(Role.kProximity) if g not in of_pieces]
        self._arm = None if standing is None else RestingArm(plant, robot, standing)
        links_shapes = [
            g
            for body in map(plant.get_body, plant.GetBodyIndices(robot))
            if not plant.IsAnchored(body)
            for g in plant.GetCollisionGeometriesForBody(body)
        ]
        # Of each shape of the robot, what it may meet: neighbours in the arm may not.
        self._meets = {
            g: [other for other in self._others if other != g and not inspector.CollisionFiltered(g, other)]
            for g in links_shapes
        }
        self._piece_of = {g: k for k, piece in enumerate(self._pieces) for g in (*piece.own, *piece.at_rest)}
        # A box for each shape: one around a bent finger would reach to what the finger passes.
        links = [
            (body, shape)
            for body in map(plant.get_body, plant.GetBodyIndices(robot))
            for shape in (extent(inspector, g) for g in plant.GetCollisionGeometriesForBody(body))
            if shape is not None and not plant.IsAnchored(body)
        ]
        rigid_items = [item for item in items if isinstance(item, RigidItem)]
        # Of links and rigid pieces at once, since one body at a time took a fifth of a run.
        self._links = [body for body, _ in links]
        self._rigid = [k for k, item in enumerate(items) if isinstance(item, RigidItem)]
        self._soft = [(k, item) for k, item in enumerate(items) if isinstance(item, SoftItem)]
        self._triangles = {k: (item, item.shape.mesh.boundary()) for k, item in self._soft}
        self._bodies = [*self._links, *(item.body for item in rigid_items)]
        self._boxes = BodyBoxes([*([shape] for _, shape in links), *(item.extents for item in rigid_items)])

    def __call__(self, root_context: Context) -> EventStatus:
        """Look, if it is time to; `root_context` belongs to the diagram that the plant is in."""
        asleep, called = (False, False) if self._arm is None else self._arm.look(root_context)
        step = round(root_context.get_time() / self._plant.time_step())
        due = root_context.get_time() >= SETTLING and not step % max(1, round(PERIOD / self._plant.time_step()))
        if not (due or called):
            return EventStatus.DidNothing()
        context = self._plant.GetMyContextFromRoot(root_context)
        stands = asleep and not called
        if stands and not any(piece.is_awake(context) for piece in self._pieces):
            return EventStatus.DidNothing()  # nothing has moved since the last look
        stands = stands or (self._arm is not None and self._arm.stands(root_context))
        pieces, arm = self._look(context, stands)
        self.set_awake(root_context, pieces, arm=arm)
        return EventStatus.Succeeded()

    def _is_awake(self, root_context: Context) -> np.ndarray:
        """Of each piece, and of the arm. Shape (n + 1,), bool."""
        context = self._plant.GetMyContextFromRoot(root_context)
        arm = self._arm is None or self._arm.is_awake(root_context)
        return np.array([*(piece.is_awake(context) for piece in self._pieces), arm])

    def names_awake(self, root_context: Context) -> list[str]:
        """What is being simulated: pieces by name, and `robot`."""
        return [name for name, awake in zip(self._names, self._is_awake(root_context), strict=True) if awake]

    def set_awake(self, root_context: Context, wanted: np.ndarray, *, arm: bool = True) -> None:
        """Wake the pieces that `wanted` (n,) names, and the `arm`, and put the others to rest.

        Args:
            root_context: of the whole diagram.
            wanted: whether each piece is to be awake. Shape (n,).
            arm: whether the arm is.
        """
        before = self._is_awake(root_context)
        after = np.append(wanted, arm or self._arm is None)
        if (before == after).all():
            return
        for piece, was, awake in zip(self._pieces, before.tolist(), wanted.tolist(), strict=False):
            if awake != was:
                (piece.wake if awake else piece.rest)(root_context)
        if self._arm is not None and before[-1] != after[-1]:
            (self._arm.wake if arm else self._arm.rest)(root_context)
        self._filter(root_context, wanted, arm_turns=bool(before[-1] != after[-1]), arm=arm)

    def _filter(self, root_context: Context, awake: np.ndarray, *, arm_turns: bool, arm: bool) -> None:
        """Let what is awake meet everything, and what rests only what is awake."""
        filters = self._scene_graph.collision_filter_manager(
            self._scene_graph.GetMyMutableContextFromRoot(root_context)
        )
        shapes: dict[bool, list[GeometryId]] = {True: [], False: []}
        for piece, stirs in zip(self._pieces, awake.tolist(), strict=True):
            shapes[stirs] += piece.own if stirs else piece.at_rest
        everything = GeometrySet([*self._others, *self._piece_of])
        declaration = CollisionFilterDeclaration()
        if arm_turns:
            for shape, others in self._meets.items():
                turn = declaration.AllowBetween if arm else declaration.ExcludeBetween
                turn(GeometrySet(shape), GeometrySet(others))
        declaration.ExcludeBetween(GeometrySet(list(self._piece_of)), everything)
        declaration.AllowBetween(GeometrySet(shapes[True]), GeometrySet([*self._others, *shapes[False]]))
        declaration.AllowWithin(GeometrySet(shapes[True]))
        filters.Apply(declaration)

    def awake(self, context: Context) -> np.ndarray:
        """Which pieces are to be simulated, given the plant's context and an arm that moves. Shape (n,), bool."""
        return self._look(context, stands=False)[0]

    def _look(self, context: Context, stands: bool) -> tuple[np.ndarray, bool]:
        """Which pieces are to be simulated, (n,), and whether the arm is; `stands`: whether it has nothing to do."""
        boxes = self._boxes([self._plant.EvalBodyPoseInWorld(context, body) for body in self._bodies])
        links, pieces = boxes[: len(self._links)], np.empty((len(self._pieces), 6))
        pieces[self._rigid] = boxes[len(self._links) :].bounds()
        for k, item in self._soft:
            nodes = soft_positions(self._plant, context, item)
            pieces[k, :3], pieces[k, 3:] = nodes.min(axis=0), nodes.max(axis=0)
        touched = self._touched(context, links, pieces)
        was_awake = [piece.is_awake(context) for piece in self._pieces]
        if not any(touched) and not any(was_awake):
            return np.zeros(len(self._pieces), dtype=bool), not stands
        sizes = (np.linalg.norm(pieces[:, 3:] - pieces[:, :3], axis=1) / 2).tolist()
        speeds = [p.speed(context, size) for p, size in zip(self._pieces, sizes, strict=True)]
        arm = not stands or any(near and speed > STILL for near, speed in zip(touched, speeds, strict=True))
        touched = [near and arm for near in touched]  # a robot that rests wakes nothing
        active = [near or speed > STILL for near, speed in zip(touched, speeds, strict=True)]
        awake = np.array(active)
        gaps, neighbours = _gaps(pieces, pieces).tolist(), []
        for j in (j for j, stirs in enumerate(active) if stirs):
            reach = NEAR + (2.0 * PERIOD * speeds[j] if np.isfinite(speeds[j]) else 0.0)
            for i in (i for i, stirs in enumerate(active) if not stirs):
                if gaps[i][j] < reach and self._near(context, pieces, i, j, reach):
                    neighbours.append((i, j))
        forces = self._forces(context) if neighbours else {}
        for i, j in neighbours:
            force = forces.get((i, j), np.zeros(3))
            carried = speeds[j] > STILL and force[2] > CARRIED * self._pieces[i].weight
            awake[i] |= carried or (touched[j] and (was_awake[i] or np.linalg.norm(force) > PRESSED))
        return awake, arm

    def _parts(self, context: Context, pieces: np.ndarray, k: int) -> np.ndarray:
        """Bounds of the parts of piece k: of the triangles of a soft one. Shape (m, 6)."""
        if k not in self._triangles:
            return pieces[k : k + 1]
        item, triangles = self._triangles[k]
        corners = soft_positions(self._plant, context, item)[triangles]
        return np.hstack([corners.min(axis=1), corners.max(axis=1)])

    def _touched(self, context: Context, links: Boxes, pieces: np.ndarray) -> list[bool]:
        """Which pieces the robot is near to."""
        gaps = links.gaps(pieces)
        if not (gaps < ROBOT_NEAR).any():
            return [False] * len(self._pieces)
        reach = np.minimum(ROBOT_NEAR, STILL_ROBOT_NEAR + 2.0 * PERIOD * self._link_speeds(context, links))
        touched = (gaps < reach).any(axis=1).tolist()
        for k, _ in self._soft:
            if touched[k]:
                touched[k] = bool((links.gaps(self._parts(context, pieces, k)) < reach).any())
        return touched

    def _link_speeds(self, context: Context, links: Boxes) -> np.ndarray:
        """At most, of any point of each shape of the robot [m/s]. Shape (m,)."""
        velocities = [self._plant.EvalBodySpatialVelocityInWorld(context, body) for body in self._links]
        turning = np.array([np.linalg.norm(V.rotational()) for V in velocities])
        origins = np.array([self._plant.EvalBodyPoseInWorld(context, body).translation() for body in self._links])
        sizes = np.linalg.norm(links.middles - origins, axis=1) + np.linalg.norm(links.halves, axis=1)
        return np.array([np.linalg.norm(V.translational()) for V in velocities]) + turning * sizes

    def _near(self, context: Context, pieces: np.ndarray, i: int, j: int, reach: float) -> bool:
        """Whether pieces i and j, whose bounds are, are nearer to each other than `reach` [m]."""
        if i not in self._triangles and j not in self._triangles:
            return True
        return bool((_gaps(self._parts(context, pieces, i), self._parts(context, pieces, j)) < reach).any())

    def _forces(self, context: Context) -> dict[tuple[int, int], np.ndarray]:
        """On piece i from piece j [N], in W, of those pairs (i, j) that touched in the last step."""
        results = self._plant.get_contact_results_output_port().Eval(context)
        forces: dict[tuple[int, int], np.ndarray] = {}
        for a, b, force_on_a in each_contact(results):
            i, j = self._piece_of.get(a), self._piece_of.get(b)
            if i is not None and j is not None:
                forces[i, j] = forces.get((i, j), np.zeros(3)) + force_on_a
                forces[j, i] = -forces[i, j]
        return forces


def rest_of(station: LioStation, *, arm: bool = True) -> Rest:
    """What lets a station's items rest, and with `arm` the robot, too.

    Args:
        station: that is looked at.
        arm: whether the robot may rest, too.
    """
    return Rest(
        plant=station.plant,
        scene_graph=station.scene_graph,
        robot=station.scene.lio,
        items=station.scene.items,
        standing=station.standing if arm else None,
    )


def _gaps(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Largest gap along an axis between bounds (n, 6) and (m, 6) [m]; negative where they overlap. Shape (n, m)."""
    return np.maximum(a[:, None, :3] - b[None, :, 3:], b[None, :, :3] - a[:, None, 3:]).max(axis=2)
