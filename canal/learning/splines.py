"""Curves through aligned demonstrations: cubic splines and Catmull-Rom rotations (paper V-A, step 3)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from splines.quaternion import CatmullRom, UnitQuaternion

from canal.rows import accumulate, rows_between

# What a squared miss along the curve counts half-way, relative to one across: (10 mm of tremor / 50 mm of smoothing of
# the alignment)²; more towards the ends, there fully. At 1 the curve spends its few knots on *when* a hand hesitated:
# 13.4 mm RMS on the recorded, 8.1 at worst on generated demonstrations; so, 12.4 and 7.9. At 4e-4 samples slide along
# it without hold, and it is worse than at 1.
TIMING_WEIGHT = 0.04
"""What a miss along the curve counts, against 1 across it: it is one of timing, not of shape."""
_FIT_ROUNDS = 3  # the direction of the curve is that of the round before; the fourth moves it by less than 0.1 mm RMS

# Gauss-Legendre on [0, 1], three points: exact to the fifth degree on each interval.
_GAUSS_AT = 0.5 + 0.5 * np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)])
_GAUSS_WEIGHT = np.array([5.0, 8.0, 5.0]) / 18.0


def knots_every(share: float) -> np.ndarray:
    """Knots every `share` (h) of the common parameter, first and last included. Shape (1/h + 1,)."""
    return np.linspace(0.0, 1.0, max(1, round(1.0 / share)) + 1)


def fit_spline(knots: np.ndarray, samples: np.ndarray, interpolate: bool) -> CubicSpline:
    """A natural cubic spline with these knots through, or closest to, samples uniform in u.

    Args:
        knots: increasing, 0 first and 1 last. Shape (K,).
        samples: [m]. Shape (M, 3).
        interpolate: pass exactly through the samples at the knots as in the paper, instead of the least-squares
            curve through the first and the last sample. Least squares keeps tremor out; it minimises
            Σ |e across the curve|² + `TIMING_WEIGHT` |e along it|², e the miss at the sample's u.
    """
    u = np.linspace(0.0, 1.0, len(samples))
    if interpolate:
        return _natural(knots, rows_between(samples, knots, u))
    # The ends are held: left free they end 18 mm from where the person did, up to 4 mm below the table.
    basis = _natural(knots, np.eye(len(knots)))(u)
    ends, inner = samples[[0, -1]], basis[:, 1:-1]
    rest = samples - basis[:, [0, -1]] @ ends
    free = _least_squares(inner, rest)
    # Demonstrations begin and end together: the variance of their timing is that of a bridge between the ends.
    timing = 1.0 / (1.0 + (1.0 / TIMING_WEIGHT - 1.0) * 4.0 * u * (1.0 - u))
    for _ in range(_FIT_ROUNDS):
        curve = _natural(knots, np.concatenate([ends[:1], free, ends[1:]]))
        along = curve(u, 1)
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
        weigh = np.eye(3) - (1.0 - np.sqrt(timing))[:, None, None] * along[:, :, None] * along[:, None, :]
        rows = (weigh[:, :, None, :] * inner[:, None, :, None]).reshape(3 * len(u), -1)
        free = _least_squares(rows, np.einsum("mij,mj->mi", weigh, rest).ravel()).reshape(-1, 3)
    return _natural(knots, np.concatenate([ends[:1], free, ends[1:]]))


def _least_squares(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The x of least |a x - b|, by the normal equations: splines that are 1 at a knot of their own are far from alike.

    A singular value decomposition of so many rows spreads over all cores and waits for them: where others are busy
    there, 150 ms a curve instead of 1.
    """
    return np.linalg.solve(a.T @ a, a.T @ b)


def _natural(knots: np.ndarray, values: np.ndarray) -> CubicSpline:
    """The natural cubic spline through values at the knots; through the unit matrix: one curve a knot."""
    return CubicSpline(knots, values, bc_type="natural")


def arc_length(curve: CubicSpline, n_intervals: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """Parameter and arc from the start at the ends of `n_intervals` equal intervals. Shapes (n+1,).

    Args:
        curve: over u in [0, 1].
        n_intervals: n, each integrated at three points (Gauss).
    """
    u = np.linspace(0.0, 1.0, n_intervals + 1)
    at = (u[:-1, None] + _GAUSS_AT * np.diff(u)[:, None]).ravel()
    speed = np.linalg.norm(curve(at, 1), axis=1).reshape(-1, 3)
    return u, accumulate(speed @ _GAUSS_WEIGHT * np.diff(u))


def uniform_in_arc(curve: CubicSpline, n: int, u_arc: tuple[np.ndarray, np.ndarray] | None = None) -> np.ndarray:
    """Parameters of `n` points uniform in the arc of a curve, ends included. Shape (n,).

    Args:
        curve: over u in [0, 1].
        n: number of points.
        u_arc: what `arc_length` says of it; computed where it is not given.
    """
    u, arc = arc_length(curve) if u_arc is None else u_arc
    grows = np.concatenate([[True], np.diff(arc) > 1e-12 * arc[-1]])
    inverse = PchipInterpolator(arc[grows], u[grows])
    at = inverse(np.linspace(0.0, arc[grows][-1], n))
    at[0], at[-1] = 0.0, 1.0
    return np.asarray(np.clip(at, 0.0, 1.0))


def rotation_curve(knots: np.ndarray, quaternions: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Catmull-Rom through rotations.

    Args:
        knots: increasing. Shape (K,).
        quaternions: unit, (w, x, y, z), one a knot. Shape (K, 4).
        at: parameters within the knots. Shape (N,).

    Returns:
        Unit quaternions (w, x, y, z), sign-continuous. Shape (N, 4).
    """
    curve = CatmullRom(
        [UnitQuaternion.from_unit_xyzw((x, y, z, w)) for w, x, y, z in quaternions.tolist()],
        knots.tolist(),
        endconditions="natural",
    )
    # De Casteljau's algorithm on the library's control points, for all parameters at once.
    control = np.array([[(q.scalar, *q.vector) for q in segment] for segment in curve.segments])
    segment = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(knots) - 2)
    t = (at - knots[segment]) / np.diff(knots)[segment]
    points = [control[segment, k] for k in range(4)]
    while len(points) > 1:
        points = [slerp(a, b, t) for a, b in pairwise(points)]
    return np.asarray(points[0])


def slerp(a: np.ndarray, b: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Row-wise spherical interpolation from `a` (t = 0) to `b` (t = 1) as points of the sphere. Shape (N, k).

    Args:
        a: unit. Shape (N, k).
        b: unit. Shape (N, k).
        t: in [0, 1]. Shape (N,).
    """
    angle = 2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(a - b, axis=1), 0.0, 1.0))
    safe = np.where(angle > 1e-8, angle, 1.0)
    first = np.where(angle > 1e-8, np.sin((1 - t) * angle) / np.sin(safe), 1 - t)
    second = np.where(angle > 1e-8, np.sin(t * angle) / np.sin(safe), t)
    blend = first[:, None] * a + second[:, None] * b
    return np.asarray(blend / np.linalg.norm(blend, axis=1, keepdims=True))
