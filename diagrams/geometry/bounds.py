"""Tight axis-aligned bounds of shapes in any pose."""

from __future__ import annotations

from collections.abc import Sequence
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
    """A convex shape in the frame P of its body, as what bounds need: a hull of points, swollen by an ellipsoid."""

    points: np.ndarray
    """Shape (n, 3), in P [m]."""
    swell: np.ndarray
    """Half axes of the ellipsoid, as rows of vectors in P [m]. Shape (3, 3); a disk or ball is a special case."""


def extent(inspector: SceneGraphInspector, geometry: GeometryId) -> Extent | None:
    """The extent of a geometry that has a proximity role; None for a shape without bounds, such as a half-space.

    Args:
        inspector: of the scene graph.
        geometry: one that has a proximity role.
    """
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


class BodyBounds:
    """Bounds of many bodies at once, each a union of shapes.

    The bounds of one shape along axis i reach from min_v (R v)_i to max_v (R v)_i over its points v, and further by
    ‖S Rᵀ e_i‖ for its ellipsoid with half axes S.
    """

    def __init__(self, bodies: Sequence[Sequence[Extent]]) -> None:
        """Stack the shapes of each of n bodies, one or more a body."""
        shapes = [shape for body in bodies for shape in body]
        self._points = np.concatenate([shape.points for shape in shapes])
        self._swells = np.array([shape.swell for shape in shapes])
        self._body_of_shape = np.repeat(np.arange(len(bodies)), [len(body) for body in bodies])
        counts = [len(shape.points) for shape in shapes]
        self._body_of_point = np.repeat(self._body_of_shape, counts)
        self._shape_starts = np.cumsum([0, *counts[:-1]])
        self._body_starts = np.cumsum([0, *(len(body) for body in bodies[:-1])])

    def __call__(self, X_WP: Sequence[RigidTransform]) -> np.ndarray:
        """Of bodies in these poses: (min x, y, z, max x, y, z) in W [m]. Shape (n, 6)."""
        poses = np.array([X.GetAsMatrix34() for X in X_WP])
        rotations, origins = poses[:, :, :3], poses[self._body_of_shape, :, 3]
        points = np.matmul(rotations[self._body_of_point], self._points[:, :, None])[:, :, 0]
        swells = np.matmul(self._swells, rotations[self._body_of_shape].transpose(0, 2, 1))
        swell = np.sqrt(np.square(swells).sum(axis=1))
        low = origins + np.minimum.reduceat(points, self._shape_starts) - swell
        high = origins + np.maximum.reduceat(points, self._shape_starts) + swell
        return np.hstack([np.minimum.reduceat(low, self._body_starts), np.maximum.reduceat(high, self._body_starts)])


@dataclass(frozen=True)
class Boxes:
    """Boxes that are turned with their bodies, in W."""

    rotations: np.ndarray
    """Axes of each as columns. Shape (n, 3, 3)."""
    middles: np.ndarray
    """[m], shape (n, 3)."""
    halves: np.ndarray
    """Half edges [m], shape (n, 3)."""
    reach: np.ndarray
    """How far each reaches from its middle along the axes of W [m]. Shape (n, 3)."""

    def __getitem__(self, part: slice) -> Boxes:
        """Some of them."""
        return Boxes(self.rotations[part], self.middles[part], self.halves[part], self.reach[part])

    def bounds(self) -> np.ndarray:
        """(min x, y, z, max x, y, z) in W [m]. Shape (n, 6)."""
        return np.concatenate((self.middles - self.reach, self.middles + self.reach), axis=1)

    def gaps(self, bounds: np.ndarray) -> np.ndarray:
        """Lower bound of the distance to axis-aligned `bounds` (m, 6) [m]; negative: they may overlap. Shape (m, n).

        The largest gap along an axis of W or of the box, of the fifteen directions that could part them.
        """
        middles, halves = (bounds[:, None, :3] + bounds[:, None, 3:]) / 2, (bounds[:, 3:] - bounds[:, :3]) / 2
        apart = middles - self.middles
        along_world = np.abs(apart) - halves[:, None] - self.reach
        # As matrix products, over the boxes: (n, m, 3), then back.
        along_box = np.abs(apart.transpose(1, 0, 2) @ self.rotations) - halves @ np.abs(self.rotations)
        along_box = along_box.transpose(1, 0, 2) - self.halves
        return np.maximum(along_world, along_box).max(axis=2)


class BodyBoxes:
    """Around each of many bodies a box along its own axes: looser than `BodyBounds`, and five times quicker."""

    def __init__(self, bodies: Sequence[Sequence[Extent]]) -> None:
        """Box the shapes of each of n bodies, one or more a body."""
        low, high = [], []
        for shapes in bodies:
            swells = [np.linalg.norm(shape.swell, axis=0) for shape in shapes]
            low.append(np.min([s.points.min(axis=0) - w for s, w in zip(shapes, swells, strict=True)], axis=0))
            high.append(np.max([s.points.max(axis=0) + w for s, w in zip(shapes, swells, strict=True)], axis=0))
        self._middles = (np.array(low) + np.array(high))[:, :, None] / 2.0
        self._halves = (np.array(high) - np.array(low)) / 2.0

    def __call__(self, X_WP: Sequence[RigidTransform]) -> Boxes:
        """Of bodies in these poses."""
        poses = np.array([X.GetAsMatrix34() for X in X_WP])
        rotations = poses[:, :, :3]
        # A box with middle c and half edges h reaches along the axes of W by |R| h.
        return Boxes(
            rotations,
            (rotations @ self._middles)[:, :, 0] + poses[:, :, 3],
            self._halves,
            (np.abs(rotations) @ self._halves[:, :, None])[:, :, 0],
        )
