"""Support planes: tables, walls and doors that no disk may reach through (paper V-B, for any direction)."""

from __future__ import annotations

import math

import numpy as np

from canal.errors import InputError
from canal.options import Coordinate, options

APPROACH = math.cos(math.radians(45.0))  # |e_T · m| from which on a path goes towards a plane, not along it


@options("support plane", frozen=True)
class SupportPlane:
    """The half-space in which the TCP may be: m · p ≥ offset, in B.

    A table of height z is `SupportPlane((0, 0, 1), z)`; a wall at y = 0.8 with the robot before it is
    `SupportPlane((0, -1, 0), -0.8)`.

    Attributes:
        normal: m, out of the table or wall; made unit (the offset scaled with it).
        offset: m · p on the plane, [m].
    """

    normal: tuple[float, float, float]
    offset: Coordinate

    def __post_init__(self) -> None:
        size = math.hypot(*self.normal)
        if not size > 1e-9:
            raise InputError(f"the normal is {self.normal}; give a direction, not zero")
        object.__setattr__(self, "normal", tuple((np.asarray(self.normal) / size).tolist()))
        object.__setattr__(self, "offset", self.offset / size)

    def height(self, points: np.ndarray) -> np.ndarray:
        """Signed distance of points (..., 3) from the plane, positive where they may be, [m]."""
        return np.asarray(points @ np.asarray(self.normal) - self.offset)


def dips(points: np.ndarray, normals: np.ndarray, radii: np.ndarray, plane: SupportPlane) -> np.ndarray:
    """How far each disk's lowest rim point lies beyond a plane (positive: it dips), [m]. Shape (N,).

    Args:
        points: centres, [m]. Shape (N, 3).
        normals: unit. Shape (N, 3).
        radii: [m]. Shape (N,).
        plane: in the same frame.
    """
    along = normals @ np.asarray(plane.normal)
    return np.asarray(radii * np.sqrt(np.maximum(0.0, 1.0 - along**2)) - plane.height(points))


def hold_at_planes(
    points: np.ndarray,
    tangents: np.ndarray,
    normals: np.ndarray,
    radii: np.ndarray,
    planes: tuple[SupportPlane, ...],
) -> dict[int, np.ndarray]:
    """The disks that dip where the path goes towards a plane, with the plane's normal as theirs.

    Args:
        points: centres of the disks, [m]. Shape (N, 3).
        tangents: unit. Shape (N, 3).
        normals: of the disks, unit. Shape (N, 3).
        radii: [m]. Shape (N,).
        planes: support planes.

    Returns:
        Normals by disk index, for `relax_normals`.

    Raises:
        InputError: a centre lies beyond a plane.
    """
    held: dict[int, np.ndarray] = {}
    for plane in planes:
        height = plane.height(points)
        if height.min() < 0:
            s = int(np.argmin(height))
            raise InputError(
                f"the canal's centre at disk {s} of {len(points)} lies {-1e3 * height[s]:.1f} mm beyond the support "
                f"plane {plane.normal}, {plane.offset:g}; move the plane, or demonstrate above it"
            )
        m = np.asarray(plane.normal)
        towards = np.abs(tangents @ m) > APPROACH
        for dipping in np.flatnonzero((dips(points, normals, radii, plane) > 0) & towards):
            held.setdefault(int(dipping), m)
    return held
