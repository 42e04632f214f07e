"""One item that can sleep: fixed where it lies, still there for what falls on it, and not computed.

A sleeping rigid item is locked (`RigidBody.Lock`), which leaves its shape where it is. A sleeping deformable one is
disabled (`DeformableModel.Disable`), and Drake then computes no contact with it. Its *collision proxy* is touched
instead: a solid of the same tetrahedra, fixed to the world, that takes the item's shape each time it falls asleep.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from pydrake.geometry import GeometryId, SceneGraph
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import UniformGravityFieldElement
from pydrake.systems.framework import Context

from diagrams.deformable.items import DeformableItem, deformable_mesh, deformable_velocities, drake_mesh
from diagrams.scene.scene import RigidItem


class SleepingItem(Protocol):
    """What sleep needs to know of an item, and does to it. Contexts are the plant's, but for `root`, the diagram's."""

    @property
    def own(self) -> list[GeometryId]:
        """Its shapes while it is awake."""
        ...

    @property
    def asleep(self) -> list[GeometryId]:
        """What stands in for them while it sleeps."""
        ...

    @property
    def weight(self) -> float:
        """[N]."""
        ...

    def speed(self, context: Context, size: float) -> float:
        """Of its fastest point [m/s], at most `size` [m] from its middle; infinite where it stands still only for a
        moment.

        Args:
            context: of the plant.
            size: from its middle to its furthest point, [m].
        """
        ...

    def is_awake(self, context: Context) -> bool:
        """Whether it is simulated."""
        ...

    def wake(self, root: Context) -> None:
        """Simulate it from now on."""
        ...

    def sleep(self, root: Context) -> None:
        """Fix it where it is."""
        ...


@dataclass(frozen=True)
class SleepingDeformable:
    """A deformable body and its collision proxy."""

    plant: MultibodyPlant
    """Finalized."""
    scene_graph: SceneGraph
    """In which the proxy takes the item's shape."""
    item: DeformableItem
    """The item, with its collision proxy."""

    @property
    def own(self) -> list[GeometryId]:
        """See `SleepingItem`."""
        return [self.item.geometry_id]

    @property
    def asleep(self) -> list[GeometryId]:
        """See `SleepingItem`."""
        return [self.item.collision_proxy_id]

    @property
    def weight(self) -> float:
        """See `SleepingItem`."""
        return UniformGravityFieldElement.kDefaultStrength * self.item.shape.mass

    def speed(self, context: Context, size: float) -> float:
        """See `SleepingItem`.

        Args:
            context: of the plant.
            size: from its middle to its furthest point, [m].
        """
        if not self.is_awake(context):
            return 0.0
        return float(np.sqrt((deformable_velocities(self.plant, context, self.item) ** 2).sum(axis=1).max()))

    def is_awake(self, context: Context) -> bool:
        """See `SleepingItem`."""
        return self.plant.deformable_model().is_enabled(self.item.body_id, context)

    def wake(self, root: Context) -> None:
        """See `SleepingItem`."""
        self.plant.deformable_model().Enable(self.item.body_id, self.plant.GetMyMutableContextFromRoot(root))

    def sleep(self, root: Context) -> None:
        """See `SleepingItem`."""
        context = self.plant.GetMyMutableContextFromRoot(root)
        self.plant.deformable_model().Disable(self.item.body_id, context)
        proxy = drake_mesh(deformable_mesh(self.plant, context, self.item), f"{self.item.name}_proxy")
        geometry = self.scene_graph.GetMyMutableContextFromRoot(root)
        self.scene_graph.ChangeShape(
            geometry, self.plant.get_source_id(), self.item.collision_proxy_id, proxy, RigidTransform()
        )


@dataclass(frozen=True)
class SleepingRigid:
    """A rigid body."""

    plant: MultibodyPlant
    """Finalized."""
    item: RigidItem
    """The item."""

    @property
    def own(self) -> list[GeometryId]:
        """See `SleepingItem`."""
        return self.plant.GetCollisionGeometriesForBody(self.item.body)

    @property
    def asleep(self) -> list[GeometryId]:
        """See `SleepingItem`."""
        return self.own

    @property
    def weight(self) -> float:
        """See `SleepingItem`."""
        return UniformGravityFieldElement.kDefaultStrength * float(self.item.body.default_mass())

    def speed(self, context: Context, size: float) -> float:
        """See `SleepingItem`.

        Args:
            context: of the plant.
            size: from its middle to its furthest point, [m].
        """
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
        """See `SleepingItem`."""
        return not self.item.body.is_locked(context)

    def wake(self, root: Context) -> None:
        """See `SleepingItem`."""
        self.item.body.Unlock(self.plant.GetMyMutableContextFromRoot(root))

    def sleep(self, root: Context) -> None:
        """See `SleepingItem`."""
        self.item.body.Lock(self.plant.GetMyMutableContextFromRoot(root))


def make_sleeping_item(
    plant: MultibodyPlant, scene_graph: SceneGraph, item: RigidItem | DeformableItem
) -> SleepingItem:
    """As its kind is.

    Args:
        plant: finalized.
        scene_graph: that the plant is registered with.
        item: one of the plant's.
    """
    return (
        SleepingDeformable(plant, scene_graph, item) if isinstance(item, DeformableItem) else SleepingRigid(plant, item)
    )


STILL = 0.003  # [m/s], of the fastest node; settled piles creep at 0.0001
UNMOVED = 0.05  # [m/s²]: where a rocking bundle turns it has no speed either, but 0.1 and more of this
