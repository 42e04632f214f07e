"""Triangles for drawing a canal: tubes, rings, discs, arrows, the canal's skin. Plain arrays, no Drake."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from canal.rows import length_along, rows_between
from canal.surface import CanalSurface


@dataclass(frozen=True)
class TriangleMesh:
    """Triangles, as Drake's Meshcat takes them.

    Attributes:
        vertices: positions [m]. Shape (3, V).
        faces: vertex indices of the triangles. Shape (3, F), int32.
    """

    vertices: np.ndarray
    faces: np.ndarray


def merge(meshes: list[TriangleMesh]) -> TriangleMesh:
    """Several meshes as one: a browser draws one large mesh faster than many small ones."""
    offsets = np.cumsum([0] + [mesh.vertices.shape[1] for mesh in meshes[:-1]])
    faces = [mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=True)]
    return TriangleMesh(np.hstack([mesh.vertices for mesh in meshes]), np.hstack(faces).astype(np.int32))


def _skin(rings: np.ndarray, closed: bool = False) -> TriangleMesh:
    """Triangles between consecutive rings of points. Shape of `rings` (n, m, 3); each ring closes on itself."""
    n, m, _ = rings.shape
    i, j = np.meshgrid(np.arange(n if closed else n - 1), np.arange(m), indexing="ij")
    a, b = i * m + j, i * m + (j + 1) % m
    c, d = (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m
    faces = np.hstack([np.stack([a, b, c]).reshape(3, -1), np.stack([b, d, c]).reshape(3, -1)])
    return TriangleMesh(rings.reshape(-1, 3).T.copy(), faces.astype(np.int32))


def circle_angles(n: int) -> np.ndarray:
    """`n` angles [rad] around the circle."""
    return np.arange(n) * (2 * np.pi / n)


def tube(points: np.ndarray, radius: float, sides: int = 6) -> TriangleMesh:
    """A tube about a polyline. `points` (n ≥ 2, 3) and `radius` in metres; closed at its ends.

    Its cross-sections do not twist: each turns into the next by the smallest rotation.

    Args:
        points: of the polyline, [m]. Shape (n ≥ 2, 3).
        radius: of the tube, [m].
        sides: corners of the tube's cross-section.
    """
    points = np.asarray(points, dtype=float)
    rings = np.empty((len(points), sides, 3))
    angles = circle_angles(sides)[:, None]
    tangent, side = np.array([0.0, 0, 1]), np.zeros(3)
    for k, direction in enumerate(np.gradient(points, axis=0)):
        length = float(np.linalg.norm(direction))
        if length > 1e-9:  # else the polyline stands still or turns back on itself here
            tangent = direction / length
        side = side - (side @ tangent) * tangent
        if np.linalg.norm(side) < 1e-6:
            side = np.cross(tangent, np.eye(3)[np.argmin(np.abs(tangent))])
        side = side / np.linalg.norm(side)
        rings[k] = points[k] + radius * (np.cos(angles) * side + np.sin(angles) * np.cross(tangent, side))
    ends = np.repeat(points[[0, -1], None, :], sides, axis=1)
    return _skin(np.concatenate([ends[:1], rings, ends[1:]]))


def dashes(points: np.ndarray, radius: float, length: float, gap: float) -> TriangleMesh:
    """A dashed tube about a polyline (n, 3): dashes of `length` with a `gap` between [m].

    Args:
        points: of the polyline, [m]. Shape (n ≥ 2, 3).
        radius: of the tube, [m].
        length: of a dash, [m].
        gap: between dashes, [m].
    """
    points = np.asarray(points, dtype=float)
    arc = length_along(points)
    tubes = []
    for start in np.arange(0.0, max(arc[-1], length), length + gap):
        along = np.linspace(start, min(start + length, arc[-1]), 4)
        tubes.append(tube(rows_between(points, along, arc), radius))
    return merge(tubes)


def ring(thickness: float, segments: int = 64, sides: int = 8) -> TriangleMesh:
    """A torus of radius 1 about z; `thickness` is the radius of its tube, relative to that 1.

    Args:
        thickness: radius of the tube, relative to the torus's.
        segments: along the torus.
        sides: corners of the tube's cross-section.
    """
    around = circle_angles(segments)
    outward = np.stack([np.cos(around), np.sin(around), np.zeros(segments)], axis=1)[:, None, :]
    turn = -circle_angles(sides)[None, :, None]
    return _skin(
        outward * (1 + thickness * np.cos(turn)) + thickness * np.sin(turn) * np.array([0, 0, 1.0]), closed=True
    )


def disc(segments: int = 64) -> TriangleMesh:
    """A flat disc of radius 1 across z."""
    around = circle_angles(segments)
    rim = np.stack([np.cos(around), np.sin(around), np.zeros(segments)], axis=1)
    j = np.arange(segments)
    faces = np.stack([np.full(segments, segments), j, (j + 1) % segments])
    return TriangleMesh(np.vstack([rim, np.zeros(3)]).T.copy(), faces.astype(np.int32))


def bead(segments: int = 8) -> TriangleMesh:
    """A ball of radius 1, coarse: it is seen small."""
    latitudes = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)[:, None]
    around = circle_angles(segments)[None, :]
    rings = np.stack(
        np.broadcast_arrays(np.cos(latitudes) * np.cos(around), np.cos(latitudes) * np.sin(around), np.sin(latitudes)),
        axis=-1,
    )
    return _skin(rings)


def arrow(shaft: float = 0.035, head: float = 0.1, head_length: float = 0.3, sides: int = 16) -> TriangleMesh:
    """An arrow of length 1 along z; radii of `shaft` and `head` relative to that 1.

    Args:
        shaft: its radius.
        head: its radius.
        head_length: along z.
        sides: corners of the tube's cross-section.
    """
    neck = 1 - head_length
    profile = np.array([[0, 0], [shaft, 0], [shaft, neck], [head, neck], [0, 1.0]])
    angles = circle_angles(sides)
    rings = np.stack(
        [
            np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(sides, z)], axis=1)
            for radius, z in profile
        ]
    )
    return _skin(rings)


def disk_rims(canal: CanalSurface, disks: np.ndarray, segments: int) -> np.ndarray:
    """Points on the rims of the canal's `disks`, clipped at its planes. Shape (len(disks), segments, 3), in B.

    Args:
        canal: in the robot's base frame.
        disks: continuous indices. Shape (P,).
        segments: number of subdivisions of the shape.
    """
    return np.array([[canal.point(disk, 1.0, phi) for phi in circle_angles(segments)] for disk in disks])


def canal_skin(canal: CanalSurface, disks: np.ndarray, segments: int = 40) -> TriangleMesh:
    """The canal's surface through the rims of `disks`; vertex k belongs to disk `disks[k // segments]`.

    Args:
        canal: in the robot's base frame.
        disks: continuous indices. Shape (P,).
        segments: number of subdivisions of the shape.
    """
    return _skin(disk_rims(canal, disks, segments))


def canal_rings(canal: CanalSurface, disks: np.ndarray, thickness: float, segments: int = 48) -> TriangleMesh:
    """The rims of `disks` as rings whose tube has the radius `thickness` [m].

    Args:
        canal: in the robot's base frame.
        disks: continuous indices. Shape (P,).
        thickness: radius of a ring's tube, [m].
        segments: number of subdivisions of the shape.
    """
    turn = -circle_angles(4)[None, :, None]
    rings = []
    for disk, rim in zip(disks, disk_rims(canal, disks, segments), strict=True):
        outward = rim - canal.center(disk)
        outward /= np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-9)
        # About the way that φ runs, so that the faces look outwards also where y is negated.
        around = np.cross(canal.x_axes[int(disk)], canal.y_axes[int(disk)])
        section = np.cos(turn) * outward[:, None, :] + np.sin(turn) * around
        rings.append(_skin(rim[:, None, :] + thickness * section, closed=True))
    return merge(rings)
