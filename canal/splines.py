"""Curves through aligned demonstrations: cubic splines and Catmull-Rom rotations (paper V-A, step 3)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from splines.quaternion import CatmullRom, UnitQuaternion

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
        samples: [m]. Shape (M, 3), or (M, ...).
        interpolate: pass exactly through the samples at the knots as in the paper, instead of the least-squares
            curve through the first and the last sample. Least squares keeps tremor out.
    """
    u = np.linspace(0.0, 1.0, len(samples))
    if interpolate:
        values = np.stack([np.interp(knots, u, column) for column in samples.T], axis=1)
    else:
        # The ends are held: left free they end 18 mm from where the person did, up to 4 mm below the table.
        basis = _cardinal(knots)(u)
        ends = samples[[0, -1]]
        inner = np.linalg.lstsq(basis[:, 1:-1], samples - basis[:, [0, -1]] @ ends, rcond=None)[0]
        values = np.concatenate([ends[:1], inner, ends[1:]])
    return CubicSpline(knots, values, bc_type="natural")


def _cardinal(knots: np.ndarray) -> CubicSpline:
    """The K natural splines that are 1 at one knot and 0 at the others."""
    return CubicSpline(knots, np.eye(len(knots)), bc_type="natural")


def arc_length(curve: CubicSpline, n_intervals: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """Parameter and arc from the start at the ends of `n_intervals` equal intervals. Shapes (n+1,)."""
    u = np.linspace(0.0, 1.0, n_intervals + 1)
    at = (u[:-1, None] + _GAUSS_AT * np.diff(u)[:, None]).ravel()
    speed = np.linalg.norm(curve(at, 1), axis=1).reshape(-1, 3)
    return u, np.concatenate([[0.0], np.cumsum(speed @ _GAUSS_WEIGHT * np.diff(u))])


def uniform_in_arc(curve: CubicSpline, n: int, u_arc: tuple[np.ndarray, np.ndarray] | None = None) -> np.ndarray:
    """Parameters of `n` points uniform in the arc of a curve, ends included. Shape (n,)."""
    u, arc = arc_length(curve) if u_arc is None else u_arc
    grows = np.concatenate([[True], np.diff(arc) > 1e-12 * arc[-1]])
    inverse = PchipInterpolator(arc[grows], u[grows])
    at = inverse(np.linspace(0.0, arc[grows][-1], n))
    at[0], at[-1] = 0.0, 1.0
    return np.clip(at, 0.0, 1.0)


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
    return points[0]


def slerp(a: np.ndarray, b: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Row-wise spherical interpolation from `a` (t = 0) to `b` (t = 1) as points of the sphere. Shape (N, k)."""
    angle = 2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(a - b, axis=1), 0.0, 1.0))
    safe = np.where(angle > 1e-8, angle, 1.0)
    first = np.where(angle > 1e-8, np.sin((1 - t) * angle) / np.sin(safe), 1 - t)
    second = np.where(angle > 1e-8, np.sin(t * angle) / np.sin(safe), t)
    blend = first[:, None] * a + second[:, None] * b
    return blend / np.linalg.norm(blend, axis=1, keepdims=True)
