"""Where the items are: poses, bounds and speeds, of rigid and of deformable ones alike."""

from __future__ import annotations

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.geometry import QueryObject
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.framework import BasicVector, Context, DiscreteValues, LeafSystem

from diagrams.deformable.items import DeformableItem
from diagrams.geometry.bounds import BodyBounds
from diagrams.geometry.pose_vector import pose_to_vector
from diagrams.scene.scene import RigidItem, Scene

PERIOD = 0.01
"""[s] Between the two samples from which a deformable item's speed is measured."""


class ItemSensor(LeafSystem):
    """Measures n items, in the order of the scenario, in W.

    ```
          body_poses → ┌────────────┐ → item_poses (7 n: position [m], quaternion w x y z)
     body_velocities → │ ItemSensor │ → item_bounds (6 n: least and greatest x, y, z of the whole shape [m])
      geometry_query → └────────────┘ → item_speeds (n: of the middle [m/s])
    ```

    A deformable item's pose is the mean of its nodes, not turned; its speed is that of the mean over the last 10 ms.
    """

    def __init__(self, scene: Scene) -> None:
        """Read the items of a scene whose plant is finalized."""
        super().__init__()
        self._items = scene.items
        self._deformable = [k for k, item in enumerate(scene.items) if isinstance(item, DeformableItem)]
        self._deformable_items = scene.deformable_items
        self._rigid = [k for k, item in enumerate(scene.items) if isinstance(item, RigidItem)]
        self._bodies = [int(item.index) for item in scene.rigid_items]
        self._rigid_bounds = BodyBounds([item.extents for item in scene.rigid_items]) if self._rigid else None
        n = len(scene.items)
        self._poses = self.DeclareAbstractInputPort("body_poses", AbstractValue.Make([RigidTransform()]))
        self._velocities = self.DeclareAbstractInputPort("body_velocities", AbstractValue.Make([SpatialVelocity()]))
        self._query = self.DeclareAbstractInputPort("geometry_query", Value[QueryObject]())
        # Middles of the deformable items, before and now; NaN until measured.
        self._middles = self.DeclareDiscreteState(np.full(6 * len(self._deformable), np.nan))
        self.DeclareVectorOutputPort("item_poses", 7 * n, self._calc_poses)
        self.DeclareVectorOutputPort("item_bounds", 6 * n, self._calc_bounds)
        self.DeclareVectorOutputPort("item_speeds", n, self._calc_speeds)
        if self._deformable:
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)

    def _nodes(self, context: Context, item: DeformableItem) -> np.ndarray:
        query = self._query.Eval(context)
        return query.GetConfigurationsInWorld(item.geometry_id).reshape(-1, 3)

    def _calc_poses(self, context: Context, output: BasicVector) -> None:
        poses = self._poses.Eval(context)
        rows = []
        for item in self._items:
            if isinstance(item, RigidItem):
                rows.append(pose_to_vector(poses[int(item.index)]))
            else:
                rows.append(np.concatenate([self._nodes(context, item).mean(axis=0), [1.0, 0.0, 0.0, 0.0]]))
        output.SetFromVector(np.concatenate(rows))

    def _calc_bounds(self, context: Context, output: BasicVector) -> None:
        bounds = np.empty((len(self._items), 6))
        if self._rigid_bounds is not None:
            poses = self._poses.Eval(context)
            bounds[self._rigid] = self._rigid_bounds([poses[body] for body in self._bodies])
        for k, item in zip(self._deformable, self._deformable_items, strict=True):
            nodes = self._nodes(context, item)
            bounds[k] = (*nodes.min(axis=0), *nodes.max(axis=0))
        output.SetFromVector(bounds.ravel())

    def _calc_speeds(self, context: Context, output: BasicVector) -> None:
        velocities = self._velocities.Eval(context)
        speeds = np.zeros(len(self._items))
        for k, item in enumerate(self._items):
            if isinstance(item, RigidItem):
                speeds[k] = np.linalg.norm(velocities[int(item.index)].translational())
        if self._deformable:
            before, now = context.get_discrete_state(self._middles).value().reshape(2, -1, 3)
            moved = np.linalg.norm(now - before, axis=1) / PERIOD
            speeds[self._deformable] = np.where(np.isfinite(moved), moved, 0.0)
        output.SetFromVector(speeds)

    def _update(self, context: Context, discrete: DiscreteValues) -> None:
        now = context.get_discrete_state(self._middles).value().reshape(2, -1)[1]
        nodes = [self._nodes(context, item) for item in self._deformable_items]
        discrete.set_value(self._middles, np.concatenate([now, *(p.mean(axis=0) for p in nodes)]))
