"""How deep points lie inside boxes that are fixed to the world: what cloth may not do."""

from __future__ import annotations

import numpy as np
from pydrake.geometry import Box, Role, SceneGraphInspector
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex


class FixedBoxes:
    """The collision boxes of models that are welded to the world, in arrays, so that many points are quick to check.

    Other shapes are left out; surroundings are made of boxes where cloth may touch them (a door's glass is not).
    """

    def __init__(self, plant: MultibodyPlant, inspector: SceneGraphInspector, models: list[ModelInstanceIndex]) -> None:
        """Collect them from a finalized plant."""
        context = plant.CreateDefaultContext()
        rotations, centers, halves = [], [], []
        for model in models:
            for index in plant.GetBodyIndices(model):
                body = plant.get_body(index)
                X_WB = plant.EvalBodyPoseInWorld(context, body)
                for geometry in inspector.GetGeometries(plant.GetBodyFrameIdOrThrow(index), Role.kProximity):
                    shape = inspector.GetShape(geometry)
                    if isinstance(shape, Box):
                        X_WG = X_WB.multiply(inspector.GetPoseInFrame(geometry))
                        rotations.append(X_WG.rotation().matrix())
                        centers.append(X_WG.translation())
                        halves.append(np.array(shape.size()) / 2.0)
        self._rotations = np.array(rotations).reshape(-1, 3, 3)
        self._centers = np.array(centers).reshape(-1, 3)
        self._halves = np.array(halves).reshape(-1, 3)
        reach = np.einsum("bij,bj->bi", np.abs(self._rotations), self._halves)
        self._low, self._high = self._centers - reach, self._centers + reach

    def depth(self, points: np.ndarray) -> float:
        """Greatest depth of `points` (n, 3) below the nearest face of a box that they lie in [m], in W; 0 outside."""
        near = np.all((self._low < points.max(axis=0)) & (self._high > points.min(axis=0)), axis=1)
        if not near.any():
            return 0.0
        relative = points[None] - self._centers[near][:, None]
        local = np.einsum("bij,bni->bnj", self._rotations[near], relative)
        depths = (self._halves[near][:, None] - np.abs(local)).min(axis=2)
        return max(0.0, float(depths.max()))
