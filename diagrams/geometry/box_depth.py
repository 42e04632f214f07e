"""How deep points lie inside solids that are fixed to the world: what cloth may not do."""

from __future__ import annotations

import numpy as np
from pydrake.geometry import Box, Convex, Role, SceneGraphInspector, Shape
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex

FACES = 6
"""Of a box."""


class FixedBoxes:
    """The collision boxes of models that are welded to the world, in arrays, so that many points are quick to check.

    A box may be given as the hull of its corners. Other shapes are left out; surroundings are made of boxes where cloth
    may touch them (a door's glass is not).
    """

    def __init__(self, plant: MultibodyPlant, inspector: SceneGraphInspector, models: list[ModelInstanceIndex]) -> None:
        """Collect them from a finalized plant."""
        context = plant.CreateDefaultContext()
        planes, corners = [], []
        for model in models:
            for index in plant.GetBodyIndices(model):
                X_WB = plant.EvalBodyPoseInWorld(context, plant.get_body(index))
                for geometry in inspector.GetGeometries(plant.GetBodyFrameIdOrThrow(index), Role.kProximity):
                    X_WG = X_WB.multiply(inspector.GetPoseInFrame(geometry))
                    found = _planes_and_corners(inspector.GetShape(geometry), X_WG)
                    if found is not None:
                        planes.append(found[0])
                        corners.append(found[1])
        self._planes = np.array(planes).reshape(-1, FACES, 4)
        spread = np.array(corners).reshape(-1, 8, 3)
        self._low, self._high = spread.min(axis=1), spread.max(axis=1)

    def depth(self, points: np.ndarray) -> float:
        """Greatest depth of `points` (n, 3) below the nearest face of a box that they lie in [m], in W; 0 outside."""
        near = np.all((self._low < points.max(axis=0)) & (self._high > points.min(axis=0)), axis=1)
        if not near.any():
            return 0.0
        planes = self._planes[near]
        return max(0.0, float((planes[:, :, None, 3] - planes[:, :, :3] @ points.T).min(axis=1).max()))


def _planes_and_corners(shape: Shape, X_WG: RigidTransform) -> tuple[np.ndarray, np.ndarray] | None:
    """Faces of a box as rows (n, n · p) with outward normals n in W, shape (6, 4), and its corners (8, 3)."""
    if isinstance(shape, Box):
        half = np.array(shape.size()) / 2.0
        signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        vertices = signs * half
    elif isinstance(shape, Convex):
        hull = shape.GetConvexHull()
        vertices = np.array([hull.vertex(i) for i in range(hull.num_vertices())])
        half = vertices.max(axis=0)
        if vertices.shape != (8, 3) or not np.allclose(np.abs(vertices), half):
            return None
    else:
        return None
    normals = np.vstack([np.eye(3), -np.eye(3)]) @ X_WG.rotation().matrix().T
    offsets = np.concatenate([half, half]) + normals @ X_WG.translation()
    corners = vertices @ X_WG.rotation().matrix().T + X_WG.translation()
    return np.column_stack([normals, offsets]), corners
