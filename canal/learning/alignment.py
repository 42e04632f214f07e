"""Alignment of demonstrations by dynamic time warping on position (paper V-A, step 2)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from canal.errors import InputError
from canal.learning.trimming import ROTATION_LENGTH_M, Motion
from canal.learning.warping import warping_path
from canal.learning_options import BAND, WARP_SMOOTHING
from canal.rows import accumulate, rows_between

ROUNDS = 3  # against the running mean, for three demonstrations and more


def align(motions: list[Motion], band: float = BAND, smoothing: float = WARP_SMOOTHING) -> np.ndarray:
    """Find where along each demonstration the common parameter is.

    For two demonstrations this is the symmetric warping path, τ = (i + j)/2; for more, each is warped against
    their running mean for a few rounds, and τ is the mean of their warps, so that none of them leads.

    Args:
        motions: n demonstrations of M points each, uniform in moved length, in canonical order.
        band: of the warping, as a share of M.
        smoothing: σ of the smoothing of the warps, as a share of M.

    Returns:
        Warps: positions in [0, M - 1] along each demonstration, at M values of τ uniform in [0, 1]. Shape
        (n, M); each row increases from 0 to M - 1, and their mean is the identity.

    Raises:
        InputError: a demonstration runs in the opposite direction.
    """
    _refuse_opposite(motions)
    curves = np.stack([motion.position for motion in motions])
    n, m, _ = curves.shape
    identity = np.arange(m, dtype=float)
    if n == 2:
        path = warping_path(curves[0], curves[1], band)
        return _centred(_smoothed(_along(path, path.mean(axis=1), m), smoothing * m))
    warps = np.tile(identity, (n, 1))
    for _ in range(ROUNDS):
        mean = np.mean([rows_between(curve, warp) for curve, warp in zip(curves, warps, strict=True)], axis=0)
        found = []
        for curve in curves:
            path = warping_path(mean, curve, band)
            found.append(_along(path, path[:, 0], m)[1])
        warps = _centred(_smoothed(np.stack(found), smoothing * m))
    return warps


def evenly_moving(motions: list[Motion], warps: np.ndarray) -> np.ndarray:
    """The same alignment with a common parameter that is uniform in what all of them move, turns included.

    Soft trimming squeezes slow ends and hesitations together in moved length. Knots uniform in that are far apart in
    space there: curves missed the ends by 15-20 mm. The step of the parameter is the root mean square of the steps of
    the demonstrations, sqrt(dp² + (λ dθ)²).

    Args:
        motions: n demonstrations of M points each.
        warps: from `align`. Shape (n, M).

    Returns:
        Warps, as from `align`; their mean is no longer the identity. Shape (n, M).
    """
    m = warps.shape[1]
    squared = np.zeros(m - 1)
    for motion, warp in zip(motions, warps, strict=True):
        squared += np.sum(np.diff(rows_between(motion.position, warp), axis=0) ** 2, axis=1)
        # A step of a quaternion is half of the angle.
        squared += (2.0 * ROTATION_LENGTH_M) ** 2 * np.sum(
            np.diff(rows_between(motion.orientation, warp), axis=0) ** 2, axis=1
        )
    moved = accumulate(np.sqrt(squared / len(motions)))
    even = moved / moved[-1] + 1e-6 * np.linspace(0.0, 1.0, m)  # strictly increasing
    at = np.interp(np.linspace(0.0, even[-1], m), even, np.arange(m, dtype=float))
    return np.stack([np.interp(at, np.arange(m), warp) for warp in warps])


def align_to(
    reference: np.ndarray, motion: Motion, band: float = BAND, smoothing: float = WARP_SMOOTHING
) -> np.ndarray:
    """Where along one demonstration the points of a reference curve are.

    Args:
        reference: a directrix, uniform in arc, [m]. Shape (M, 3).
        motion: of as many points.
        band: as in `align`.
        smoothing: as in `align`.

    Returns:
        Positions in [0, M - 1] along the demonstration, from 0 to M - 1. Shape (M,).

    Raises:
        InputError: it runs in the opposite direction.
    """
    _refuse_opposite([replace(motion, position=reference, name="the canal"), motion])
    m = len(reference)
    path = warping_path(reference, motion.position, band)
    return np.asarray(_smoothed(_along(path, path[:, 0], m)[1:], smoothing * m)[0])


def _along(path: np.ndarray, tau: np.ndarray, m: int) -> np.ndarray:
    """Both columns of a warping path as functions of `tau`, at 0..m-1. Shape (2, m).

    Where τ stands still on the path the mean of what is paired with it is taken.
    """
    values, first, count = np.unique(tau, return_index=True, return_counts=True)
    sums = np.add.reduceat(path, first, axis=0) / count[:, None]
    sums[0], sums[-1] = path[0], path[-1]
    return np.stack([np.interp(np.arange(m, dtype=float), values, column) for column in sums.T])


def _smoothed(warps: np.ndarray, sigma: float) -> np.ndarray:
    """Warps smoothed along τ with their ends kept (point reflection); they stay increasing. Shape (n, m)."""
    m = warps.shape[1]
    if sigma <= 0:
        return warps
    pad = min(m - 1, int(np.ceil(4 * sigma)))
    ahead = warps - np.arange(m)
    padded = np.concatenate([-ahead[:, pad:0:-1], ahead, -ahead[:, -2 : -pad - 2 : -1]], axis=1)
    smooth = gaussian_filter1d(padded, sigma, axis=1, mode="nearest")[:, pad : pad + m] + np.arange(m)
    smooth = np.clip(np.maximum.accumulate(smooth, axis=1), 0.0, m - 1.0)
    smooth[:, 0], smooth[:, -1] = 0.0, m - 1.0
    return smooth


def _centred(warps: np.ndarray) -> np.ndarray:
    """Warps over their own mean, so that no demonstration leads. Shape (n, m)."""
    m = warps.shape[1]
    mean = np.mean(warps, axis=0)
    mean = (mean + 1e-6 * np.arange(m)) * ((m - 1) / (m - 1 + 1e-6 * (m - 1)))  # strictly increasing
    return np.stack([np.interp(np.arange(m, dtype=float), mean, warp) for warp in warps])


def _refuse_opposite(motions: list[Motion]) -> None:
    first = motions[0]
    for other in motions[1:]:
        along = np.mean(np.sum((first.position - other.position) ** 2, axis=1))
        against = np.mean(np.sum((first.position - other.position[::-1]) ** 2, axis=1))
        ends_along = np.sum((first.position[[0, -1]] - other.position[[0, -1]]) ** 2)
        ends_against = np.sum((first.position[[0, -1]] - other.position[[-1, 0]]) ** 2)
        if against < 0.5 * along and ends_against <= ends_along + 1e-12:
            raise InputError(
                f"{other.name} runs in the opposite direction to {first.name} (mean distance "
                f"{1e3 * np.sqrt(along):.0f} mm, {1e3 * np.sqrt(against):.0f} mm when reversed); record both from "
                "pick to place"
            )
