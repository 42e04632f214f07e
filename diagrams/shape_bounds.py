"""Tight axis-aligned bounds of shapes in any pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydrake.geometry import (
    Box,
    Capsule,
    Convex,
    Cylinder,
    Ellipsoid,
    GeometryId,
    Mesh,
    SceneGraphInspector,
    Sphere,
)
from pydrake.math import RigidTransform


@dataclass(frozen=True)
class Extent:
    """A convex shape in the frame P of its body, as what bounds need: a hull of points, swollen by an ellipsoid.

    The bounds of R K along axis i reach from min_v (R v)_i to max_v (R v)_i over the points v, and further by
    ‖S Rᵀ e_i‖ for the ellipsoid with half axes S (a disk or ball as a special case).
    """

    points: np.ndarray
    """Shape (n, 3), in P [m]."""
    swell: np.ndarray
    """Half axes of the ellipsoid, as rows of vectors in P [m]. Shape (3, 3)."""

    def bounds(self, rotation: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest coordinates in W [m] for R_WP (3, 3) and p_WP (3,)."""
        points = self.points @ rotation.T
        swell = np.sqrt(np.square(self.swell @ rotation.T).sum(axis=0))
        return position + points.min(axis=0) - swell, position + points.max(axis=0) + swell


def extent(inspector: SceneGraphInspector, geometry: GeometryId) -> Extent | None:
    """The extent of a geometry that has a proximity role; None for a shape without bounds, such as a half-space."""
    shape, X = inspector.GetShape(geometry), inspector.GetPoseInFrame(geometry)
    points, swell = np.zeros((1, 3)), np.zeros((3, 3))
    if isinstance(shape, Sphere):
        swell = shape.radius() * np.eye(3)
    elif isinstance(shape, Ellipsoid):
        swell = np.diag([shape.a(), shape.b(), shape.c()])
    elif isinstance(shape, Cylinder):
        points = np.array([[0, 0, s * shape.length() / 2] for s in (-1, 1)])
        swell = np.diag([shape.radius(), shape.radius(), 0.0])
    elif isinstance(shape, Capsule):
        points = np.array([[0, 0, s * shape.length() / 2] for s in (-1, 1)])
        swell = shape.radius() * np.eye(3)
    elif isinstance(shape, Box):
        points = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array(shape.size()) / 2
    elif isinstance(shape, Mesh | Convex):
        hull = shape.GetConvexHull()
        points = np.array([hull.vertex(i) for i in range(hull.num_vertices())])
    else:
        return None
    R = X.rotation().matrix()
    return Extent(points @ R.T + X.translation(), swell @ R.T)


def union_bounds(extents: list[Extent], X_WP: RigidTransform) -> np.ndarray:
    """Bounds of all shapes of a body: (min x, y, z, max x, y, z) in W [m]. Shape (6,)."""
    R, p = X_WP.rotation().matrix(), X_WP.translation()
    pairs = [e.bounds(R, p) for e in extents]
    return np.concatenate([np.min([low for low, _ in pairs], axis=0), np.max([high for _, high in pairs], axis=0)])
