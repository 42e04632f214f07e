"""Puts items to sleep: one that lies still on something still is not simulated until something stirs it.

A sleeping item stays where it is, is met by others as a fixed solid, and costs nothing (a step of three deformable
items: 3.9 ms awake, 0.3 ms asleep; a sock that falls on a towel: 6.5 ms with the towel awake, 1.9 ms asleep, and it
comes to lie within 4 mm of where it would). It wakes *before* the robot touches it, when what bears it moves, and when
the robot presses something against it; what merely comes to lie on it, or beside it, does not wake it.
The arm sleeps with all that lies in its hand and about it (see `sleeping_arm`); then it is furniture like any other.
Which items sleep is a parameter of the plant and of the scene graph in the Context; nothing is kept here.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.geometry import CollisionFilterDeclaration, GeometryId, GeometrySet, Role, SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import Context, EventStatus

from diagrams.deformable.items import DeformableItem, deformable_positions
from diagrams.geometry.bounds import BodyBoxes, Boxes, extent
from diagrams.geometry.contacts import each_contact
from diagrams.scene.scene import RigidItem
from diagrams.station.lio_station import LioStation
from diagrams.station.sleeping_arm import SleepingArm, Standing
from diagrams.station.sleeping_item import STILL, make_sleeping_item

PERIOD = 0.02  # [s]
SETTLING = 0.06  # [s]: at the start everything hangs in the air with no speed
NEAR = 0.012  # [m] between bounds; what moves may come nearer than this by two periods of its speed
STILL_ROBOT_NEAR = 0.003  # [m] between bounds, while the robot stands; while it moves, two periods of its speed more,
ROBOT_NEAR = 0.015  # [m] but no more than this: it moves at up to 0.3 m/s
CARRIED = 0.25  # share of an item's weight: what bears more of it takes it along
PRESSED = 15.0  # [N]: what the robot presses harder against an item moves it; blows of falling cloth stay below
# Bounds of a deformable item are those of each triangle of its surface: a long one that lies aslant has a large box
# around it, and would be woken by what only passes.


class SleepManager:
    """A monitor for Drake's Simulator: puts the items of a plant to sleep and wakes them, every 20 ms."""

    def __init__(
        self,
        *,
        plant: MultibodyPlant,
        scene_graph: SceneGraph,
        robot: ModelInstanceIndex,
        items: Sequence[RigidItem | DeformableItem],
        standing: Standing | None = None,
    ) -> None:
        """Watch these.

        Args:
            plant: finalized.
            scene_graph: of the plant.
            robot: what wakes items by coming near.
            items: the items.
            standing: in the path of the robot's command; None for a robot that never sleeps.
        """
        self._plant = plant
        self._scene_graph = scene_graph
        self._items = [make_sleeping_item(plant, scene_graph, item) for item in items]
        self._names = [*(item.name for item in items), "robot"]
        inspector = scene_graph.model_inspector()
        of_items = {g for item in self._items for g in (*item.own, *item.asleep)}
        self._others = [g for g in inspector.GetAllGeometryIds(Role.kProximity) if g not in of_items]
        self._arm = None if standing is None else SleepingArm(plant, robot, standing)
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
        self._item_of = {g: k for k, item in enumerate(self._items) for g in (*item.own, *item.asleep)}
        # A box for each shape: one around a bent finger would reach to what the finger passes.
        links = [
            (body, shape)
            for body in map(plant.get_body, plant.GetBodyIndices(robot))
            for shape in (extent(inspector, g) for g in plant.GetCollisionGeometriesForBody(body))
            if shape is not None and not plant.IsAnchored(body)
        ]
        rigid_items = [item for item in items if isinstance(item, RigidItem)]
        # Of links and rigid items at once, since one body at a time took a fifth of a run.
        self._links = [body for body, _ in links]
        self._rigid = [k for k, item in enumerate(items) if isinstance(item, RigidItem)]
        self._deformable = [(k, item) for k, item in enumerate(items) if isinstance(item, DeformableItem)]
        self._triangles = {k: (item, item.shape.mesh.boundary()) for k, item in self._deformable}
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
        if stands and not any(item.is_awake(context) for item in self._items):
            return EventStatus.DidNothing()  # nothing has moved since the last look
        stands = stands or (self._arm is not None and self._arm.stands(root_context))
        awake, arm = self._look(context, stands)
        self.set_awake(root_context, awake, arm=arm)
        return EventStatus.Succeeded()

    def _is_awake(self, root_context: Context) -> np.ndarray:
        """Of each item, and of the arm. Shape (n + 1,), bool."""
        context = self._plant.GetMyContextFromRoot(root_context)
        return np.array([*(item.is_awake(context) for item in self._items), self.is_robot_awake(root_context)])

    def is_robot_awake(self, root_context: Context) -> bool:
        """Whether the arm is simulated; while it sleeps, nothing that presses on it changes."""
        return self._arm is None or self._arm.is_awake(root_context)

    def names_awake(self, root_context: Context) -> list[str]:
        """What is being simulated: items by name, and `robot`."""
        return [name for name, awake in zip(self._names, self._is_awake(root_context), strict=True) if awake]

    def set_awake(self, root_context: Context, wanted: np.ndarray, *, arm: bool = True) -> None:
        """Wake the items that `wanted` (n,) names, and the `arm`, and put the others to sleep.

        Args:
            root_context: of the whole diagram.
            wanted: whether each item is to be awake. Shape (n,).
            arm: whether the arm is.
        """
        before = self._is_awake(root_context)
        after = np.append(wanted, arm or self._arm is None)
        if (before == after).all():
            return
        for item, was, awake in zip(self._items, before.tolist(), wanted.tolist(), strict=False):
            if awake != was:
                (item.wake if awake else item.sleep)(root_context)
        if self._arm is not None and before[-1] != after[-1]:
            (self._arm.wake if arm else self._arm.sleep)(root_context)
        self._filter(root_context, wanted, arm_turns=bool(before[-1] != after[-1]), arm=arm)

    def _filter(self, root_context: Context, awake: np.ndarray, *, arm_turns: bool, arm: bool) -> None:
        """Let what is awake meet everything, and what sleeps only what is awake."""
        filters = self._scene_graph.collision_filter_manager(
            self._scene_graph.GetMyMutableContextFromRoot(root_context)
        )
        shapes: dict[bool, list[GeometryId]] = {True: [], False: []}
        for item, stirs in zip(self._items, awake.tolist(), strict=True):
            shapes[stirs] += item.own if stirs else item.asleep
        everything = GeometrySet([*self._others, *self._item_of])
        declaration = CollisionFilterDeclaration()
        if arm_turns:
            for shape, others in self._meets.items():
                turn = declaration.AllowBetween if arm else declaration.ExcludeBetween
                turn(GeometrySet(shape), GeometrySet(others))
        declaration.ExcludeBetween(GeometrySet(list(self._item_of)), everything)
        declaration.AllowBetween(GeometrySet(shapes[True]), GeometrySet([*self._others, *shapes[False]]))
        declaration.AllowWithin(GeometrySet(shapes[True]))
        filters.Apply(declaration)

    def awake(self, context: Context) -> np.ndarray:
        """Which items are to be simulated, given the plant's context and an arm that moves. Shape (n,), bool."""
        return self._look(context, stands=False)[0]

    def _look(self, context: Context, stands: bool) -> tuple[np.ndarray, bool]:
        """Which items are to be simulated, (n,), and whether the arm is; `stands`: whether it has nothing to do."""
        boxes = self._boxes([self._plant.EvalBodyPoseInWorld(context, body) for body in self._bodies])
        links, bounds = boxes[: len(self._links)], np.empty((len(self._items), 6))
        bounds[self._rigid] = boxes[len(self._links) :].bounds()
        for k, item in self._deformable:
            nodes = deformable_positions(self._plant, context, item)
            bounds[k, :3], bounds[k, 3:] = nodes.min(axis=0), nodes.max(axis=0)
        touched = self._touched(context, links, bounds)
        was_awake = [item.is_awake(context) for item in self._items]
        if not any(touched) and not any(was_awake):
            return np.zeros(len(self._items), dtype=bool), not stands
        sizes = (np.linalg.norm(bounds[:, 3:] - bounds[:, :3], axis=1) / 2).tolist()
        speeds = [p.speed(context, size) for p, size in zip(self._items, sizes, strict=True)]
        arm = not stands or any(near and speed > STILL for near, speed in zip(touched, speeds, strict=True))
        touched = [near and arm for near in touched]  # a robot that sleeps wakes nothing
        active = [near or speed > STILL for near, speed in zip(touched, speeds, strict=True)]
        awake = np.array(active)
        gaps, neighbours = _gaps(bounds, bounds).tolist(), []
        for j in (j for j, stirs in enumerate(active) if stirs):
            reach = NEAR + (2.0 * PERIOD * speeds[j] if np.isfinite(speeds[j]) else 0.0)
            for i in (i for i, stirs in enumerate(active) if not stirs):
                if gaps[i][j] < reach and self._near(context, bounds, i, j, reach):
                    neighbours.append((i, j))
        forces = self._forces(context) if neighbours else {}
        for i, j in neighbours:
            force = forces.get((i, j), np.zeros(3))
            carried = speeds[j] > STILL and force[2] > CARRIED * self._items[i].weight
            awake[i] |= carried or (touched[j] and (was_awake[i] or np.linalg.norm(force) > PRESSED))
        return awake, arm

    def _parts(self, context: Context, bounds: np.ndarray, k: int) -> np.ndarray:
        """Bounds of the parts of item k: of the triangles of a deformable one. Shape (m, 6)."""
        if k not in self._triangles:
            return bounds[k : k + 1]
        item, triangles = self._triangles[k]
        corners = deformable_positions(self._plant, context, item)[triangles]
        return np.hstack([corners.min(axis=1), corners.max(axis=1)])

    def _touched(self, context: Context, links: Boxes, bounds: np.ndarray) -> list[bool]:
        """Which items the robot is near to."""
        gaps = links.gaps(bounds)
        if not (gaps < ROBOT_NEAR).any():
            return [False] * len(self._items)
        reach = np.minimum(ROBOT_NEAR, STILL_ROBOT_NEAR + 2.0 * PERIOD * self._link_speeds(context, links))
        touched = (gaps < reach).any(axis=1).tolist()
        for k, _ in self._deformable:
            if touched[k]:
                touched[k] = bool((links.gaps(self._parts(context, bounds, k)) < reach).any())
        return touched

    def _link_speeds(self, context: Context, links: Boxes) -> np.ndarray:
        """At most, of any point of each shape of the robot [m/s]. Shape (m,)."""
        velocities = [self._plant.EvalBodySpatialVelocityInWorld(context, body) for body in self._links]
        turning = np.array([np.linalg.norm(V.rotational()) for V in velocities])
        origins = np.array([self._plant.EvalBodyPoseInWorld(context, body).translation() for body in self._links])
        sizes = np.linalg.norm(links.middles - origins, axis=1) + np.linalg.norm(links.halves, axis=1)
        return np.array([np.linalg.norm(V.translational()) for V in velocities]) + turning * sizes

    def _near(self, context: Context, bounds: np.ndarray, i: int, j: int, reach: float) -> bool:
        """Whether items i and j, whose bounds are, are nearer to each other than `reach` [m]."""
        if i not in self._triangles and j not in self._triangles:
            return True
        return bool((_gaps(self._parts(context, bounds, i), self._parts(context, bounds, j)) < reach).any())

    def _forces(self, context: Context) -> dict[tuple[int, int], np.ndarray]:
        """On item i from item j [N], in W, of those pairs (i, j) that touched in the last step."""
        results = self._plant.get_contact_results_output_port().Eval(context)
        forces: dict[tuple[int, int], np.ndarray] = {}
        for a, b, force_on_a in each_contact(results):
            i, j = self._item_of.get(a), self._item_of.get(b)
            if i is not None and j is not None:
                forces[i, j] = forces.get((i, j), np.zeros(3)) + force_on_a
                forces[j, i] = -forces[i, j]
        return forces


def sleep_manager(station: LioStation, *, arm: bool = True) -> SleepManager:
    """What puts a station's items to sleep, and with `arm` the robot, too.

    Args:
        station: that is looked at.
        arm: whether the robot may sleep, too.
    """
    return SleepManager(
        plant=station.plant,
        scene_graph=station.scene_graph,
        robot=station.scene.lio,
        items=station.scene.items,
        standing=station.standing if arm else None,
    )


def _gaps(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Largest gap along an axis between bounds (n, 6) and (m, 6) [m]; negative where they overlap. Shape (n, m)."""
    return np.maximum(a[:, None, :3] - b[None, :, 3:], b[None, :, :3] - a[:, None, 3:]).max(axis=2)
