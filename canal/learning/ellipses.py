"""Elliptic cross-sections: tighter than the circle, never smaller than the data."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

FEWEST_FOR_ELLIPSES = 3  # two demonstrations lie on a line through the centre
_ROUNDEST_SHARE = 0.1  # of the mean square, given to every direction: a thumb needs room also across the data
_EVEN = 0.04  # share of the disks, σ of the evening out of their shapes
_BISECTIONS = 40


def disk_ellipses(offsets: np.ndarray, x_axes: np.ndarray, y_axes: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """An ellipse a disk, about its centre, that contains the projected demonstrations and lies in the circle.

    Its shape is that of the demonstrations' second moment, which changes as smoothly as they do; it is scaled to
    contain them, and made rounder only as far as it would leave the circle.

    Args:
        offsets: aligned points from the centres, [m]. Shape (n, N, 3).
        x_axes: of the disks, unit. Shape (N, 3).
        y_axes: likewise. Shape (N, 3).
        radii: [m]. Shape (N,); what they hold beyond the data (a margin) is added to both semi-axes.

    Returns:
        Semi-axes a ≥ b [m] and the angle of a from x [rad] in (-π/2, π/2]. Shape (N, 3).
    """
    points = np.stack([np.sum(offsets * x_axes, axis=2), np.sum(offsets * y_axes, axis=2)], axis=2)
    ball = np.linalg.norm(offsets, axis=2).max(axis=0)
    tiny = ball < 1e-9
    unit = points / np.where(tiny, 1.0, ball)[:, None]
    moment = np.einsum("nsi,nsj->sij", unit, unit) / len(unit)
    reach = max(1, round(_EVEN * len(radii)))
    moment = gaussian_filter1d(moment, reach, axis=0, mode="nearest", truncate=2.0)
    trace = np.trace(moment, axis1=1, axis2=2)
    moment = moment + (_ROUNDEST_SHARE * trace + 1e-9)[:, None, None] * np.eye(2)
    narrow = np.linalg.inv(moment)
    # In units of the ball the circle is the identity: the wanted form is (1 - t) narrow + t 1, scaled to the data.
    narrow /= np.linalg.eigvalsh(narrow)[:, :1, None]
    low, high = np.zeros(len(radii)), np.ones(len(radii))
    for _ in range(_BISECTIONS):
        t = 0.5 * (low + high)
        fits = np.linalg.eigvalsh(_scaled(narrow, t, unit))[:, 0] >= 1.0
        low, high = np.where(fits, low, t), np.where(fits, t, high)
    # Rounder is allowed everywhere: an even bound from above, since a rim that jumps cannot be steered along.
    round_enough = maximum_filter1d(high, 4 * reach + 1, mode="nearest")
    round_enough = gaussian_filter1d(round_enough, reach, mode="nearest", truncate=2.0)
    values, vectors = np.linalg.eigh(_scaled(narrow, np.minimum(round_enough, 1.0), unit))
    a, b = 1.0 / np.sqrt(values[:, 0]), 1.0 / np.sqrt(values[:, 1])
    angle = np.arctan2(vectors[:, 1, 0], vectors[:, 0, 0])
    angle = np.where(angle > np.pi / 2, angle - np.pi, np.where(angle <= -np.pi / 2, angle + np.pi, angle))
    size, room = np.where(tiny, 0.0, ball), radii - ball
    return np.column_stack([np.minimum(size * a, size) + room, size * np.minimum(b, a) + room, angle])


def _scaled(narrow: np.ndarray, roundness: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Quadratic forms between narrow and round whose unit ellipse just contains the points. Shape (N, 2, 2)."""
    t = roundness[:, None, None]
    form = (1.0 - t) * narrow + t * np.eye(2)
    reach = np.einsum("nsi,sij,nsj->ns", points, form, points).max(axis=0)
    return np.asarray(form / np.maximum(reach, 1e-12)[:, None, None])
