"""Normals of the disks: the tangents, relaxed until neighbouring disks do not cross inside the canal."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solveh_banded

ROOM = 0.9  # share of the gap between neighbours that a tilt may use up
MAX_TILT = np.radians(30.0)  # [rad] beyond this a disk is no cross-section any more
_TARGET = 0.86  # aimed at; ascent ends when all are below ROOM
_FIRST, _STIFFEST = 0.05, 1e7  # multipliers of |n_{s+1} - n_s|², against 1 of |n_s - e_T|²
_MAX_ROUNDS = 300
_GIVEN_UP = 1e-6  # weight of a disk in a hairpin
_TURNS_BACK = -0.5  # cosine of the angle between the directions into and out of a hairpin: 120°
_ONE_HAIRPIN = 4  # [disks] tight links no further apart belong together
_HELD = 1e9  # weight of a disk that is held, against 1 for one that follows its tangent


def crossings(points: np.ndarray, normals: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """How much of the gap between neighbours their mutual tilt uses up: they cross from 1 on.

    r |n_s × n_{s+1}| / |Δc · n| with the larger of the two radii and the smaller of the two gaps. Shape (N-1,).

    Args:
        points: centres, [m]. Shape (N, 3).
        normals: unit. Shape (N, 3).
        radii: [m]. Shape (N,).
    """
    reach = np.maximum(radii[1:], radii[:-1]) * np.linalg.norm(np.cross(normals[1:], normals[:-1]), axis=1)
    delta = np.diff(points, axis=0)
    gap = np.minimum(
        np.abs(np.sum(delta * normals[1:], axis=1)),
        np.abs(np.sum(delta * normals[:-1], axis=1)),
    )
    return np.where(reach <= 1e-12, 0.0, reach / np.maximum(gap, 1e-15))


def continuous_directions(vectors: np.ndarray, hairpins: list[tuple[int, int]] | None = None) -> np.ndarray:
    """Vectors with the sign that makes n_s · n_{s-1} > 0: disks retrace their way at a reversal. Shape (N, 3).

    In a hairpin (first and last disk) the sign changes once, half-way.

    Args:
        vectors: Shape (N, 3).
        hairpins: first and last disk of each, see `reversals`.
    """
    turns = np.sum(vectors[1:] * vectors[:-1], axis=1) < 0
    for first, last in hairpins or []:
        turns[first:last] = False
        turns[(first + last) // 2] = True
    sign = np.where(np.cumsum(turns) % 2 == 1, -1.0, 1.0)
    return np.concatenate([vectors[:1], vectors[1:] * sign[:, None]])


def relax_normals(
    points: np.ndarray,
    tangents: np.ndarray,
    radii: np.ndarray,
    held: dict[int, np.ndarray] | None = None,
) -> np.ndarray:
    """Tilt disks as little and as locally as it takes for neighbours not to cross.

    Minimises Σ |n_s - e_T(s)|² under a bound on each |n_{s+1} - n_s|, by ascent on the bounds' multipliers: only
    links that would cross get one. Centres and radii stay as they are.

    Args:
        points: centres, [m]. Shape (N, 3).
        tangents: unit. Shape (N, 3).
        radii: [m]. Shape (N,).
        held: disks whose normal is given (at a support plane), by index.

    Returns:
        Unit normals, sign-continuous, within 30° of the tangents. Shape (N, 3). A disk that is held may lie further,
        and so do those of a hairpin (see `reversals`). Neighbours that still cross lie in an elbow tighter than the
        radius, which no tilt cures; see `crossings`.
    """
    turns = reversals(points, tangents, radii)
    signed = continuous_directions(tangents, turns)
    weight = np.ones(len(signed))
    stiffness = np.zeros(len(signed) - 1)
    for first, last in turns:
        weight[first : last + 1] = _GIVEN_UP
        stiffness[first:last] = 1.0
    wanted = signed.copy()
    for s, normal in (held or {}).items():
        weight[s] = _HELD
        wanted[s] = normal if normal @ wanted[s] >= 0 else -normal
    normals = _smoothed(wanted, weight, stiffness) if turns else wanted
    best, least = normals, np.inf
    for _ in range(_MAX_ROUNDS):
        share = crossings(points, normals, radii)
        excess = float(np.sum(np.maximum(share - ROOM, 0.0)))
        if excess < least:
            best, least = normals, excess
        if excess == 0.0:
            break
        # Multiplicative ascent on the multipliers: a link that uses less than its room is let go again.
        pulled = np.where(share > _TARGET, np.maximum(stiffness, _FIRST), stiffness)
        stiffness = np.minimum(pulled * np.clip(share / _TARGET, 0.5, 4.0), _STIFFEST)
        normals = _smoothed(wanted, weight, stiffness)
    # What is left is an elbow tighter than the radius: tilted on, its disks would lie along the path.
    limit = max([MAX_TILT, *(tilts(wanted[[s]], tangents[[s]])[0] for s in (held or {}))])
    within = _within(best, signed, limit)
    for first, last in turns:
        within[first : last + 1] = best[first : last + 1]
    return within


def reversals(points: np.ndarray, tangents: np.ndarray, radii: np.ndarray) -> list[tuple[int, int]]:
    """Where a path turns back within less than the radius: first and last disk of each such hairpin.

    Its disks cannot turn over with it without crossing; they retrace their way instead.

    Args:
        points: centres, [m]. Shape (N, 3).
        tangents: unit. Shape (N, 3).
        radii: [m]. Shape (N,).
    """
    tight = np.flatnonzero(crossings(points, tangents, radii) > 1.0)
    runs = np.split(tight, np.flatnonzero(np.diff(tight) > _ONE_HAIRPIN) + 1) if tight.size else []
    ends = [(int(run[0]), int(run[-1]) + 1) for run in runs]
    return [(first, last) for first, last in ends if tangents[first] @ tangents[last] < _TURNS_BACK]


def _smoothed(wanted: np.ndarray, weight: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Unit vectors n that minimise Σ w_s |n_s - wanted_s|² + Σ k_s |n_{s+1} - n_s|² before they are made unit."""
    banded = np.zeros((2, len(wanted)))
    banded[1] = weight
    banded[1, :-1] += stiffness
    banded[1, 1:] += stiffness
    banded[0, 1:] = -stiffness
    relaxed = solveh_banded(banded, weight[:, None] * wanted)
    size = np.linalg.norm(relaxed, axis=1, keepdims=True)
    return np.where(size > 1e-9, relaxed / np.maximum(size, 1e-9), wanted)


def _within(normals: np.ndarray, centres: np.ndarray, limit: float) -> np.ndarray:
    """Unit vectors moved, along the sphere, to within an angle of others. Shape (N, 3)."""
    across = normals - np.sum(normals * centres, axis=1)[:, None] * centres
    size = np.linalg.norm(across, axis=1)
    angle = np.arctan2(size, np.sum(normals * centres, axis=1))
    far = angle > limit
    edge = np.cos(limit) * centres + np.sin(limit) * across / np.maximum(size, 1e-12)[:, None]
    return np.where(far[:, None], edge, normals)


def tilts(normals: np.ndarray, tangents: np.ndarray) -> np.ndarray:
    """Angle between each disk's normal and the tangent, up to sign, [rad]. Shape (N,).

    Args:
        normals: unit. Shape (N, 3).
        tangents: unit. Shape (N, 3).
    """
    cross = np.linalg.norm(np.cross(normals, tangents), axis=1)
    return np.arctan2(cross, np.abs(np.sum(normals * tangents, axis=1)))
