"""A learned canal moved to new end poses: the machine stands elsewhere, the basket is lower."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation, Slerp

from canal.editing import beyond_data, own_options, rebuild
from canal.errors import InputError
from canal.quality import angles, canal_quality, curvature
from canal.rows import rows_between
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface

_EVEN = 0.05  # share of the length over which curvature is averaged when shapes are compared
_MODES = 4
_STRETCH_PRICE = 20.0  # μ: at 1 the shortest ways come out crushed, at 100 every way comes out as long as it was
_MOST_STEPS = 40
_LONGEST_STEP = 0.5  # [rad]
_TINY = 1e-6
WARN_CURVATURE = 1.5  # times the old
WARN_STRETCH = 1.5  # or shrinkage


@dataclass(frozen=True)
class ShapeCost:
    """What bending a canal to new ends has cost in shape.

    Attributes:
        curvature_ratio: largest curvature (over 5 % of the length) after, relative to before.
        length_ratio: length after, relative to before.
        stretch_max: largest local stretch or shrinkage of the directrix, as a ratio ≥ 1.
        turn_max_deg: largest turn of a tangent, [°].
        moved_max_m: largest displacement of a disk, [m].
        n_crossing: neighbouring disks that cross, after.
    """

    curvature_ratio: float
    length_ratio: float
    stretch_max: float
    turn_max_deg: float
    moved_max_m: float
    n_crossing: int

    def __str__(self) -> str:
        return (
            f"curvature × {self.curvature_ratio:.2f}, length × {self.length_ratio:.2f}, locally × "
            f"{self.stretch_max:.2f} at most, turned by {self.turn_max_deg:.0f}° and moved by "
            f"{1e3 * self.moved_max_m:.0f} mm at most, {self.n_crossing} disks cross"
        )


def retarget(
    canal: CanalSurface,
    pick: ArrayLike | tuple[ArrayLike, ArrayLike] | None = None,
    place: ArrayLike | tuple[ArrayLike, ArrayLike] | None = None,
    support_planes: tuple[SupportPlane, ...] | None = None,
) -> CanalSurface:
    """Bend a canal so that it begins and ends at new poses.

    The canal's steps are turned by a rotation that passes smoothly from the pick's to the place's; what is then
    missing at the end is made up by a field of small rotations, none at the ends, and one stretch of the whole,
    that together cost least. (Laplacian editing, which displaces points instead of turning steps, crushes whatever
    lies across the displacement: its curvature doubled where this one's grows by 1.4.) If both ends move as one
    body the canal moves as that body, exactly. Demonstrations keep their offsets, so radii and spread of
    orientations are carried along; frames are made anew, since x_G is the person's and stays.

    Args:
        canal: learned.
        pick: X_BT of the new first pose: 7 numbers (position [m], quaternion w, x, y, z), or a pair of them, or a
            position alone, which keeps the orientation; None keeps the pose.
        place: of the last pose, likewise.
        support_planes: where the tables and walls are now; None keeps them.

    Returns:
        The canal; see `shape_cost` for what it costs. A cost that is high is among its warnings.

    Raises:
        InputError: a pose that is not finite, or a centre beyond a support plane.
    """
    c = canal.directrix
    first, turn_first = _target(pick, "pick", c[0], canal.orientations[0])
    last, turn_last = _target(place, "place", c[-1], canal.orientations[-1])
    between = Slerp([0.0, 1.0], Rotation.concatenate([turn_first, turn_last]))
    x = canal.arc / canal.length
    middle = 0.5 * (x[1:] + x[:-1])
    steps = between(_level(middle)).apply(np.diff(c, axis=0))
    bending, log_stretch = _least_bending(middle, steps, last - first)
    steps = np.exp(log_stretch) * _bend(middle, bending).apply(steps)
    centres = first + np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    centres = centres + _level(x)[:, None] * (last - centres[-1])  # what is too far for bending alone
    turns = between(_level(x))
    offsets = _bend(x, bending) * turns

    positions = np.stack([centres + offsets.apply(curve - c) for curve in canal.demonstrations])
    quaternions = np.stack([_turned(turns, q) for q in canal.demonstration_orientations])
    length = float(np.sum(np.linalg.norm(np.diff(centres, axis=0), axis=1)))
    bent = rebuild(
        canal,
        positions,
        quaternions,
        moving_time_s=canal.moving_time_s * length / canal.length,
        beyond=beyond_data(canal, np.arange(canal.n_disks)),
        options=replace(own_options(canal), support_planes=support_planes) if support_planes is not None else None,
    )
    old_weights = np.interp(
        np.linspace(0, 1, bent.n_disks), np.linspace(0, 1, canal.n_disks), canal.orientation_weights
    )
    cost = shape_cost(canal, bent)
    warnings = bent.warnings
    if cost.curvature_ratio > WARN_CURVATURE or cost.stretch_max > WARN_STRETCH:
        warnings += (f"bent to its new ends at a cost: {cost}",)
    return replace(bent, orientation_weights=old_weights, warnings=warnings)


def _level(x: np.ndarray) -> np.ndarray:
    """From 0 to 1, starting and ending level."""
    return np.asarray(x * x * (3.0 - 2.0 * x))


def _bend(x: np.ndarray, bending: np.ndarray) -> Rotation:
    """Rotations Σ_k a_k sin(kπx): none at the ends. `bending` (K, 3), [rad]."""
    modes = np.sin(np.pi * np.outer(x, np.arange(1, len(bending) + 1)))
    return Rotation.from_rotvec(modes @ bending)


def _least_bending(x: np.ndarray, steps: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, float]:
    """Bending and log-stretch of a chain of steps that reaches a point, at least ∫ |ω'|² + μ (log stretch)².

    Args:
        x: where each step is, in [0, 1]. Shape (M,).
        steps: [m]. Shape (M, 3).
        reach: from the first point to the last, [m]. Shape (3,).

    Returns:
        a_k, [rad], of shape (K, 3), and the logarithm of the stretch.
    """
    size = 3 * _MODES + 1
    price = np.concatenate([np.repeat((np.pi * np.arange(1, _MODES + 1)) ** 2 / 2, 3), [_STRETCH_PRICE]])

    def end(z: np.ndarray) -> np.ndarray:
        return np.asarray(np.exp(z[-1]) * _bend(x, z[:-1].reshape(_MODES, 3)).apply(steps).sum(axis=0))

    z = np.zeros(size)
    for _ in range(_MOST_STEPS):
        missing = reach - end(z)
        if np.abs(missing).max() < 1e-10:
            break
        jacobian = np.stack([(end(z + d) - end(z - d)) / (2 * _TINY) for d in _TINY * np.eye(size)], axis=1)
        cheap = jacobian / price
        wanted = missing + jacobian @ z
        better = cheap.T @ np.linalg.solve(jacobian @ cheap.T + 1e-12 * np.eye(3), wanted)
        z = z + (better - z) * min(1.0, _LONGEST_STEP / max(float(np.abs(better - z).max()), 1e-12))
    return z[:-1].reshape(_MODES, 3), float(z[-1])


def shape_cost(before: CanalSurface, after: CanalSurface) -> ShapeCost:
    """Compare a canal with what it was bent into.

    Args:
        before: as it was.
        after: as it is now, with any number of disks.
    """
    u = np.linspace(0.0, 1.0, 401)
    old, new = (rows_between(canal.directrix, u, canal.arc / canal.length) for canal in (before, after))
    tangent_old, tangent_new = (rows_between(canal.tangents, u, canal.arc / canal.length) for canal in (before, after))
    tangent_old /= np.linalg.norm(tangent_old, axis=1, keepdims=True)
    tangent_new /= np.linalg.norm(tangent_new, axis=1, keepdims=True)
    stretch = np.linalg.norm(np.diff(new, axis=0), axis=1) / np.linalg.norm(np.diff(old, axis=0), axis=1)
    return ShapeCost(
        curvature_ratio=_peak_curvature(after) / max(_peak_curvature(before), 1e-9),
        length_ratio=after.length / before.length,
        stretch_max=float(np.exp(np.abs(np.log(stretch)).max())),
        turn_max_deg=float(angles(tangent_old, tangent_new).max()),
        moved_max_m=float(np.linalg.norm(new - old, axis=1).max()),
        n_crossing=canal_quality(after).n_crossing,
    )


def _peak_curvature(canal: CanalSurface) -> float:
    """Largest curvature, averaged over 5 % of the length, [1/m]."""
    width = max(1, round(_EVEN * canal.n_disks))
    return float(np.convolve(curvature(canal), np.full(width, 1.0 / width), mode="valid").max())


def _target(
    pose: ArrayLike | tuple[ArrayLike, ArrayLike] | None, name: str, position: np.ndarray, quaternion: np.ndarray
) -> tuple[np.ndarray, Rotation]:
    """New position, and the rotation from the old orientation to the new one."""
    if pose is None:
        return position, Rotation.identity()
    parts = pose if isinstance(pose, tuple) and len(pose) == 2 else (pose,)
    try:
        numbers = np.concatenate([np.asarray(part, dtype=float).ravel() for part in parts])
    except (TypeError, ValueError):
        numbers = np.empty(0)
    if numbers.size not in (3, 7) or not np.isfinite(numbers).all():
        raise InputError(f"{name} pose {pose}; give 3 finite numbers [m], or 7 with a quaternion w, x, y, z")
    if numbers.size == 3:
        return numbers, Rotation.identity()
    norm = np.linalg.norm(numbers[3:])
    if not 0.5 < norm < 2.0:
        raise InputError(f"{name} pose has a quaternion of norm {norm:.3g}; it must be unit, w, x, y, z")
    old = Rotation.from_quat(quaternion, scalar_first=True)
    return numbers[:3], Rotation.from_quat(numbers[3:], scalar_first=True) * old.inv()


def _turned(turns: Rotation, quaternions: np.ndarray) -> np.ndarray:
    return np.asarray((turns * Rotation.from_quat(quaternions, scalar_first=True)).as_quat(scalar_first=True))
