"""The canal surface: disks along a directrix, and points on them at any continuous disk index."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from canal.demonstration import Demonstration
from canal.learning_options import MEASURED, LearningOptions
from canal.refinement import SupportPlane
from canal.surface_file import read_canal_fields, save_canal

MIN_RADIUS = 1e-9
"""[m] Below this a disk is a point: there is nothing to correct, and the ratio is carried through it."""


@dataclass(frozen=True, eq=False)
class CanalSurface:
    """A learned canal (paper III and IV): N disks, in the robot's base frame B. Lengths in metres.

    A *disk* argument is a continuous index in [0, N-1], clipped to it: pick is 0, home is `home_disk`, place is
    N-1. Between disks centres, radii and weights are linear, axes and orientations are blended and kept unit.

    Attributes:
        directrix: centres c(s). Shape (N, 3).
        radii: r(s), all aligned demonstrations lie in the balls. Shape (N,).
        tangents: e_T(s), unit. Shape (N, 3).
        normals: n(s), unit, the disks' normals after relaxation. Shape (N, 3).
        x_axes: correction x_s, unit, in the disk. Shape (N, 3).
        y_axes: correction y_s, unit, in the disk, ± n × x. Shape (N, 3).
        orientations: mean TCP orientation, (w, x, y, z), sign-continuous. Shape (N, 4).
        orientation_sd: σ_q(s). Shape (N,).
        orientation_weights: w_o(s). Shape (N,).
        demonstrations: the aligned demonstrations, disk by disk. Shape (n, N, 3).
        demonstration_orientations: their orientations, sign-continuous. Shape (n, N, 4).
        moving_time_s: mean time the demonstrations spent moving, [s].
        ellipses: semi-axes a and b and the angle of a from x_s, [m, m, rad], where the cross-sections are
            ellipses. Shape (N, 3), or None for circles.
        support_planes: where points are clipped.
        x_global: x_G that the correction frames follow. Shape (3,).
        warnings: what a person should know about this canal, one line each.
        options: how it was learned; what makes another canal of it uses them.
    """

    directrix: np.ndarray
    radii: np.ndarray
    tangents: np.ndarray
    normals: np.ndarray
    x_axes: np.ndarray
    y_axes: np.ndarray
    orientations: np.ndarray
    orientation_sd: np.ndarray
    orientation_weights: np.ndarray
    demonstrations: np.ndarray
    demonstration_orientations: np.ndarray
    moving_time_s: float
    ellipses: np.ndarray | None = None
    support_planes: tuple[SupportPlane, ...] = ()
    x_global: np.ndarray = None  # type: ignore[assignment]
    warnings: tuple[str, ...] = ()
    options: LearningOptions = MEASURED

    def __post_init__(self):
        if self.x_global is None:
            object.__setattr__(self, "x_global", np.array([1.0, 0.0, 0.0]))
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value = np.array(value, dtype=float)
                value.setflags(write=False)
                object.__setattr__(self, field.name, value)
        # Plain floats: the 100 Hz loop asks for single disks, where numpy costs ten times as much.
        rows = np.column_stack([self.directrix, self.radii, self.x_axes, self.y_axes]).tolist()
        object.__setattr__(self, "_rows", rows)
        object.__setattr__(self, "_quaternions", self.orientations.tolist())
        object.__setattr__(self, "_weights", self.orientation_weights.tolist())
        object.__setattr__(self, "_last", len(rows) - 1)
        object.__setattr__(self, "_ellipses", None if self.ellipses is None else self.ellipses.tolist())
        object.__setattr__(self, "_planes", [(*p.normal, p.offset) for p in self.support_planes])
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(self.directrix, axis=0), axis=1))])
        arc.setflags(write=False)
        object.__setattr__(self, "_arc", arc)

    def __repr__(self) -> str:
        return f"CanalSurface({self.n_disks} disks, {self.length:.3f} m, {len(self.demonstrations)} demonstrations)"

    @property
    def n_disks(self) -> int:
        """N_f."""
        return self._last + 1  # type: ignore[attr-defined]

    @property
    def home_disk(self) -> int:
        """The middle disk, half of the arc."""
        return self._last // 2  # type: ignore[attr-defined]

    @property
    def length(self) -> float:
        """Arc length of the directrix, [m]."""
        return float(self.arc[-1])

    @property
    def arc(self) -> np.ndarray:
        """Arc length from the first disk to each disk, [m]. Shape (N,)."""
        return self._arc  # type: ignore[attr-defined]

    def center(self, disk: float) -> np.ndarray:
        """c at a continuous disk, [m]. Shape (3,)."""
        return np.array(self._frame(disk)[:3])

    def radius(self, disk: float) -> float:
        """r at a continuous disk, [m]: of the circle, also where cross-sections are ellipses."""
        i, t = self._at(disk)
        rows = self._rows  # type: ignore[attr-defined]
        return rows[i][3] + t * (rows[i + 1][3] - rows[i][3])

    def axes(self, disk: float) -> tuple[np.ndarray, np.ndarray]:
        """Correction axes x and y at a continuous disk, orthonormal. Shapes (3,)."""
        frame = self._frame(disk)
        return np.array(frame[4:7]), np.array(frame[7:10])

    def widest_homewards(self, disk: float) -> float:
        """The largest radius over the spacing of disks, r/|Δc|, between a continuous disk and home.

        So many disks of travel are as long as the largest radius there.
        """
        return self._widest[self._at(disk)[0]]

    @cached_property
    def _widest(self) -> list[float]:
        wide = np.maximum(self.radii[:-1], self.radii[1:]) / np.maximum(np.diff(self.arc), 1e-9)
        pick, place = wide[: self.home_disk], wide[self.home_disk :]
        return [*np.maximum.accumulate(pick[::-1])[::-1].tolist(), *np.maximum.accumulate(place).tolist()]

    def extent(self, disk: float, phi: float) -> float:
        """Distance from the centre to the rim in the direction φ [rad], [m]: r, or the ellipse's. Planes not seen."""
        ellipses = self._ellipses  # type: ignore[attr-defined]
        if ellipses is None:
            return self.radius(disk)
        i, t = self._at(disk)
        first = _polar(ellipses[i], phi)
        return first + t * (_polar(ellipses[i + 1], phi) - first)

    def point(self, disk: float, eta: float, phi: float) -> np.ndarray:
        """p = c + η r (cos φ x + sin φ y), [m], clipped at support planes. Shape (3,).

        Args:
            disk: continuous index.
            eta: ratio η in [0, 1].
            phi: φ, [rad].
        """
        cx, cy, cz, r, ax, ay, az, bx, by, bz = self._frame(disk)
        if self._ellipses is not None:  # type: ignore[attr-defined]
            r = self.extent(disk, phi)
        a = eta * r * math.cos(phi)
        b = eta * r * math.sin(phi)
        dx, dy, dz = a * ax + b * bx, a * ay + b * by, a * az + b * bz
        for mx, my, mz, offset in self._planes:  # type: ignore[attr-defined]
            height = mx * cx + my * cy + mz * cz - offset
            drop = -(mx * dx + my * dy + mz * dz)
            if drop > max(height, 0.0):  # along the disk, towards the centre, so that φ stays
                share = max(0.0, height / drop)
                dx, dy, dz = share * dx, share * dy, share * dz
        return np.array((cx + dx, cy + dy, cz + dz))

    def orientation(self, disk: float) -> np.ndarray:
        """Mean TCP orientation at a continuous disk, unit (w, x, y, z). Shape (4,)."""
        i, t = self._at(disk)
        w0, x0, y0, z0 = self._quaternions[i]  # type: ignore[attr-defined]
        w1, x1, y1, z1 = self._quaternions[i + 1]  # type: ignore[attr-defined]
        s = 1.0 - t
        # Neighbours are a few degrees apart at most: the normalised chord is the arc to 1e-5 rad.
        w, x, y, z = s * w0 + t * w1, s * x0 + t * x1, s * y0 + t * y1, s * z0 + t * z1
        k = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
        return np.array((k * w, k * x, k * y, k * z))

    def weight(self, disk: float) -> float:
        """Orientation weight w_o at a continuous disk."""
        i, t = self._at(disk)
        weights = self._weights  # type: ignore[attr-defined]
        return weights[i] + t * (weights[i + 1] - weights[i])

    def disk_coordinates(self, disk: float, p: np.ndarray) -> tuple[float, float]:
        """(η, φ) of the projection of a point [m] on a disk: η ≥ 0 (above 1 outside), φ in (-π, π] rad.

        Both are 0 where the radius is (almost) zero.
        """
        cx, cy, cz, r, ax, ay, az, bx, by, bz = self._frame(disk)
        px, py, pz = p
        dx, dy, dz = px - cx, py - cy, pz - cz
        u, v = dx * ax + dy * ay + dz * az, dx * bx + dy * by + dz * bz
        phi = math.atan2(v, u)
        if self._ellipses is not None:  # type: ignore[attr-defined]
            r = self.extent(disk, phi)
        if r < MIN_RADIUS:
            return 0.0, 0.0
        return math.hypot(u, v) / r, phi

    def _at(self, disk: float) -> tuple[int, float]:
        """The disk below, at most N-2, and how far towards the next."""
        last = self._last  # type: ignore[attr-defined]
        if disk <= 0.0:
            return 0, 0.0
        if disk >= last:
            return last - 1, 1.0
        i = int(disk)
        return i, disk - i

    def _frame(self, disk: float):
        """Centre, radius, x and y at a continuous disk: 10 floats."""
        i, t = self._at(disk)
        rows = self._rows  # type: ignore[attr-defined]
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

    def save(self, path: str | os.PathLike) -> None:
        """Write the canal to one `.npz`; `load` gives it back bit for bit."""
        save_canal(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike) -> CanalSurface:
        """Read a canal written by `save`, or by any program that writes the documented arrays.

        Raises:
            InputError: it is not a canal file, with what is missing or wrong.
        """
        return cls(**read_canal_fields(path))

    def retarget(
        self,
        pick: ArrayLike | tuple[ArrayLike, ArrayLike] | None = None,
        place: ArrayLike | tuple[ArrayLike, ArrayLike] | None = None,
        support_planes: tuple[SupportPlane, ...] | None = None,
    ) -> CanalSurface:
        """This canal bent to new end poses; see `canal.retargeting.retarget` and `shape_cost`."""
        from canal.retargeting import retarget

        return retarget(self, pick, place, support_planes)

    def reverse(self) -> CanalSurface:
        """This canal from place to pick, with the same disks and the same correction frames."""
        from canal.editing import reverse

        return reverse(self)

    def cut(self, first: float, last: float) -> CanalSurface:
        """The part between two disks as a canal of its own; see `canal.editing.cut`."""
        from canal.editing import cut

        return cut(self, first, last)

    def join(self, following: CanalSurface) -> CanalSurface:
        """This canal and the one that follows it as one; see `canal.editing.join`."""
        from canal.editing import join

        return join(self, following)

    def add_demonstration(self, demonstration: Demonstration) -> CanalSurface:
        """This canal with one more demonstration; the recorded old ones are not needed."""
        from canal.editing import add_demonstration

        return add_demonstration(self, demonstration)

    def with_(self, **changes) -> CanalSurface:
        """A copy with some fields replaced."""
        return replace(self, **changes)


def _polar(ellipse: list[float], phi: float) -> float:
    """Distance from the centre to the rim of an ellipse in the direction φ; 0 for one without extent."""
    a, b, angle = ellipse
    c, s = b * math.cos(phi - angle), a * math.sin(phi - angle)
    size = math.sqrt(c * c + s * s)
    return a * b / size if size > 1e-15 else 0.0
