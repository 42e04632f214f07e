"""The canal surface: disks along a directrix, and points on them at any continuous disk index."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from canal.disk_lookup import MIN_RADIUS, DiskLookup
from canal.learning_options import MEASURED, LearningOptions
from canal.support_planes import SupportPlane

__all__ = ["MIN_RADIUS", "CanalSurface"]


@dataclass(frozen=True, eq=False)
class CanalSurface:
    """A learned canal (paper III and IV): N disks, in the robot's base frame B. Lengths in metres.

    A *disk* argument is a continuous index in [0, N-1], clipped to it: pick is 0, home is `home_disk`, place is
    N-1. Between disks centres, radii and weights are linear, axes and orientations are blended and kept unit.
    Functions beside it make, change and keep canals: `canal.learning.learn_canal`, `canal.editing`,
    `canal.retargeting`, `canal.surface_file`.

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
    x_global: np.ndarray = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    warnings: tuple[str, ...] = ()
    options: LearningOptions = MEASURED
    _lookup: DiskLookup = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for name in (f.name for f in fields(self) if f.init):
            value = getattr(self, name)
            if isinstance(value, np.ndarray):
                value = np.array(value, dtype=float)
                value.setflags(write=False)
                object.__setattr__(self, name, value)
        planes = [(*plane.normal, plane.offset) for plane in self.support_planes]
        lookup = DiskLookup(
            centers=self.directrix,
            radii=self.radii,
            x_axes=self.x_axes,
            y_axes=self.y_axes,
            orientations=self.orientations,
            weights=self.orientation_weights,
            ellipses=self.ellipses,
            planes=planes,
        )
        object.__setattr__(self, "_lookup", lookup)

    def __repr__(self) -> str:
        return f"CanalSurface({self.n_disks} disks, {self.length:.3f} m, {len(self.demonstrations)} demonstrations)"

    @property
    def n_disks(self) -> int:
        """N_f."""
        return self._lookup.last + 1

    @property
    def home_disk(self) -> int:
        """The middle disk, half of the arc."""
        return self._lookup.last // 2

    @property
    def length(self) -> float:
        """Arc length of the directrix, [m]."""
        return float(self.arc[-1])

    @property
    def arc(self) -> np.ndarray:
        """Arc length from the first disk to each disk, [m]. Shape (N,)."""
        return self._lookup.arc

    def center(self, disk: float) -> np.ndarray:
        """c at a continuous disk, [m]. Shape (3,)."""
        return np.array(self._lookup.frame(disk)[:3])

    def radius(self, disk: float) -> float:
        """r at a continuous disk, [m]: of the circle, also where cross-sections are ellipses."""
        return self._lookup.radius(disk)

    def axes(self, disk: float) -> tuple[np.ndarray, np.ndarray]:
        """Correction axes x and y at a continuous disk, orthonormal. Shapes (3,)."""
        frame = self._lookup.frame(disk)
        return np.array(frame[4:7]), np.array(frame[7:10])

    def widest_homewards(self, disk: float) -> float:
        """The largest radius over the spacing of disks, r/|Δc|, between a continuous disk and home.

        So many disks of travel are as long as the largest radius there.
        """
        return self._lookup.widest_homewards(disk)

    def extent(self, disk: float, phi: float) -> float:
        """Distance from the centre to the rim in the direction φ [rad], [m]: r, or the ellipse's. Planes not seen.

        Args:
            disk: continuous index.
            phi: φ, [rad].
        """
        return self._lookup.extent(disk, phi)

    def point(self, disk: float, eta: float, phi: float) -> np.ndarray:
        """p = c + η r (cos φ x + sin φ y), [m], clipped at support planes. Shape (3,).

        Args:
            disk: continuous index.
            eta: ratio η in [0, 1].
            phi: φ, [rad].
        """
        return np.array(self._lookup.point(disk, eta, phi))

    def orientation(self, disk: float) -> np.ndarray:
        """Mean TCP orientation at a continuous disk, unit (w, x, y, z). Shape (4,)."""
        return np.array(self._lookup.orientation(disk))

    def pose(self, disk: float, eta: float = 0.0, phi: float = 0.0) -> np.ndarray:
        """Pose of the TCP at a point of the canal: position [m], then the disk's mean orientation. Shape (7,).

        Args:
            disk: continuous index.
            eta: ratio η in [0, 1].
            phi: φ, [rad].
        """
        return np.array((*self._lookup.point(disk, eta, phi), *self._lookup.orientation(disk)))

    def weight(self, disk: float) -> float:
        """Orientation weight w_o at a continuous disk."""
        return self._lookup.weight(disk)

    def disk_coordinates(self, disk: float, p: np.ndarray) -> tuple[float, float]:
        """(η, φ) of the projection of a point [m] on a disk: η ≥ 0 (above 1 outside), φ in (-π, π] rad.

        Both are 0 where the radius is (almost) zero.

        Args:
            disk: continuous index.
            p: the point in B, [m]. Shape (3,).
        """
        return self._lookup.disk_coordinates(disk, p)
