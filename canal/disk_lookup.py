"""Disks looked up at a continuous index, in plain floats.

The navigator's loop asks for single disks at 60 to 1000 Hz. There numpy costs ten times as much as lists of floats do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from canal.rows import length_along

MIN_RADIUS = 1e-9
"""[m] Below this a disk is a point: there is nothing to correct, and the ratio is carried through it."""

Floats = Sequence[float]
"""A few plain floats: numpy costs ten times as much for single disks."""


class DiskLookup:
    """Centres, radii, axes, orientations and weights between the disks of a canal.

    What `canal.surface.CanalSurface` answers with; its methods say what each query means.

    Attributes:
        last: index of the last disk, N-1.
        arc: arc length from the first disk to each, read-only, [m]. Shape (N,).
    """

    def __init__(
        self,
        *,
        centers: np.ndarray,
        radii: np.ndarray,
        x_axes: np.ndarray,
        y_axes: np.ndarray,
        orientations: np.ndarray,
        weights: np.ndarray,
        ellipses: np.ndarray | None,
        planes: Sequence[Floats],
    ) -> None:
        """Copy the arrays of a canal.

        Args:
            centers: [m]. Shape (N, 3).
            radii: [m]. Shape (N,).
            x_axes: unit. Shape (N, 3).
            y_axes: unit. Shape (N, 3).
            orientations: unit quaternions (w, x, y, z), sign-continuous. Shape (N, 4).
            weights: orientation weights. Shape (N,).
            ellipses: semi-axes and the angle of the first, [m, m, rad]. Shape (N, 3), or None for circles.
            planes: unit normal and offset [m] of each support plane, 4 floats each.
        """
        self._rows: list[list[float]] = np.column_stack([centers, radii, x_axes, y_axes]).tolist()
        self._quaternions: list[list[float]] = orientations.tolist()
        self._weights: list[float] = weights.tolist()
        self._ellipses: list[list[float]] | None = None if ellipses is None else ellipses.tolist()
        self._planes = planes
        self._radii = radii
        self.last = len(self._rows) - 1
        self.arc = length_along(centers)
        self.arc.setflags(write=False)

    def at(self, disk: float) -> tuple[int, float]:
        """The disk below, at most N-2, and how far towards the next, in [0, 1]."""
        if disk <= 0.0:
            return 0, 0.0
        if disk >= self.last:
            return self.last - 1, 1.0
        i = int(disk)
        return i, disk - i

    def frame(self, disk: float) -> Floats:
        """Centre, radius, x and y: 10 floats."""
        i, t = self.at(disk)
        rows = self._rows
        if t == 0.0:
            return rows[i]
        if t == 1.0:
            return rows[i + 1]
        s = 1.0 - t
        cx, cy, cz, r, ax, ay, az, bx, by, bz = [s * a + t * b for a, b in zip(rows[i], rows[i + 1], strict=True)]
        k = ax * ax + ay * ay + az * az
        k = 1.0 / math.sqrt(k) if k > 0 else 0.0
        ax, ay, az = k * ax, k * ay, k * az
        d = ax * bx + ay * by + az * bz
        bx, by, bz = bx - d * ax, by - d * ay, bz - d * az
        k = bx * bx + by * by + bz * bz
        k = 1.0 / math.sqrt(k) if k > 0 else 0.0
        return cx, cy, cz, r, ax, ay, az, k * bx, k * by, k * bz

    def radius(self, disk: float) -> float:
        """r, [m]."""
        i, t = self.at(disk)
        rows = self._rows
        return rows[i][3] + t * (rows[i + 1][3] - rows[i][3])

    def extent(self, disk: float, phi: float) -> float:
        """Distance from the centre to the rim in the direction φ [rad], [m].

        Args:
            disk: continuous index.
            phi: φ, [rad].
        """
        if self._ellipses is None:
            return self.radius(disk)
        i, t = self.at(disk)
        first = _polar(self._ellipses[i], phi)
        return first + t * (_polar(self._ellipses[i + 1], phi) - first)

    def point(self, disk: float, eta: float, phi: float) -> tuple[float, float, float]:
        """The point (η, φ) of a disk, clipped at the support planes, [m].

        Args:
            disk: continuous index.
            eta: ratio η in [0, 1].
            phi: φ, [rad].

        Returns:
            x, y and z in B, [m].
        """
        cx, cy, cz, r, ax, ay, az, bx, by, bz = self.frame(disk)
        if self._ellipses is not None:
            r = self.extent(disk, phi)
        a = eta * r * math.cos(phi)
        b = eta * r * math.sin(phi)
        dx, dy, dz = a * ax + b * bx, a * ay + b * by, a * az + b * bz
        for mx, my, mz, offset in self._planes:
            height = mx * cx + my * cy + mz * cz - offset
            drop = -(mx * dx + my * dy + mz * dz)
            if drop > max(height, 0.0):  # along the disk, towards the centre, so that φ stays
                share = max(0.0, height / drop)
                dx, dy, dz = share * dx, share * dy, share * dz
        return cx + dx, cy + dy, cz + dz

    def orientation(self, disk: float) -> tuple[float, float, float, float]:
        """Mean orientation, unit (w, x, y, z)."""
        i, t = self.at(disk)
        w0, x0, y0, z0 = self._quaternions[i]
        w1, x1, y1, z1 = self._quaternions[i + 1]
        s = 1.0 - t
        # Neighbours are a few degrees apart at most: the normalised chord is the arc to 1e-5 rad.
        w, x, y, z = s * w0 + t * w1, s * x0 + t * x1, s * y0 + t * y1, s * z0 + t * z1
        k = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
        return k * w, k * x, k * y, k * z

    def weight(self, disk: float) -> float:
        """Orientation weight w_o."""
        i, t = self.at(disk)
        return self._weights[i] + t * (self._weights[i + 1] - self._weights[i])

    def disk_coordinates(self, disk: float, p: Floats | np.ndarray) -> tuple[float, float]:
        """(η, φ [rad]) of the projection of a point [m] on a disk; zeros where the disk is a point.

        Args:
            disk: continuous index.
            p: the point in B, [m]. Shape (3,).
        """
        cx, cy, cz, r, ax, ay, az, bx, by, bz = self.frame(disk)
        px, py, pz = p
        dx, dy, dz = px - cx, py - cy, pz - cz
        u, v = dx * ax + dy * ay + dz * az, dx * bx + dy * by + dz * bz
        phi = math.atan2(v, u)
        if self._ellipses is not None:
            r = self.extent(disk, phi)
        if r < MIN_RADIUS:
            return 0.0, 0.0
        return math.hypot(u, v) / r, phi

    def widest_homewards(self, disk: float) -> float:
        """The largest r/|Δc| between a disk and home."""
        return self._widest[self.at(disk)[0]]

    @cached_property
    def _widest(self) -> list[float]:
        wide = np.maximum(self._radii[:-1], self._radii[1:]) / np.maximum(np.diff(self.arc), 1e-9)
        home = self.last // 2
        pick, place = wide[:home], wide[home:]
        return [*np.maximum.accumulate(pick[::-1])[::-1].tolist(), *np.maximum.accumulate(place).tolist()]


def _polar(ellipse: list[float], phi: float) -> float:
    """Distance from the centre to the rim of an ellipse in the direction φ; 0 for one without extent."""
    a, b, angle = ellipse
    c, s = b * math.cos(phi - angle), a * math.sin(phi - angle)
    size = math.sqrt(c * c + s * s)
    return a * b / size if size > 1e-15 else 0.0
