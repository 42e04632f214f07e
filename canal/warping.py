"""Dynamic time warping of two curves (paper V-A, step 2; Sakoe and Chiba 1978)."""

from __future__ import annotations

import numpy as np

# Squared distances are rounded to this, [m²] (4 µm at zero): sums of them are then exact, so that a tie is a
# tie however the data are turned, and the warping path the same.
_QUANTUM = 2.0**-36


def warping_path(a: np.ndarray, b: np.ndarray, band: float) -> np.ndarray:
    """The pairs (i, j) from (0, 0) to (M - 1, M - 1) of least summed squared distance.

    A few lines of numpy instead of tslearn, whose path this is, pair by pair (a test compares them): importing
    tslearn costs more than all the rest of learning in a fresh process, its just-in-time compilation 5 s more, and
    its loops without compilation 14 ms a path instead of 3.

    Args:
        a, b: curves of as many points, [m]. Shapes (M, 3), M ≥ 2.
        band: how far the path may run ahead or behind, as a share of M (Sakoe-Chiba).

    Returns:
        i and j along the path; of equal ways the diagonal one, then the one along a. Shape (P, 2).
    """
    squared = np.sum((a[:, None, :] - b[None, :, :]) ** 2, axis=2)
    total = _accumulated(np.round(squared / _QUANTUM) * _QUANTUM, max(1, round(band * len(a))))
    i = j = len(a)
    path = [(i, j)]
    while (i, j) != (1, 1):
        ahead = total[i - 1, j - 1], total[i - 1, j], total[i, j - 1]
        least = ahead.index(min(ahead))
        i, j = i - (least != 2), j - (least != 1)
        path.append((i, j))
    return np.array(path[::-1]) - 1


def _accumulated(cost: np.ndarray, radius: int) -> np.ndarray:
    """Least sum of costs up to each pair within the band, ∞ outside, with a border of ∞ in front. Shape (M+1, M+1).

    Pairs with the same i + j do not depend on each other: one antidiagonal is done at a time, as a slice of the
    flat array.
    """
    m = len(cost)
    total = np.full((m + 1, m + 1), np.inf)
    total[0, 0] = 0.0
    sums, costs = total.ravel(), cost.ravel()
    for s in range(2, 2 * m + 1):
        low, high = max(1, s - m, (s - radius + 1) // 2), min(m, s - 1, (s + radius) // 2)
        here, end = low * m + s, high * m + s + 1
        before = np.minimum(sums[here - m - 1 : end - m - 1 : m], sums[here - 1 : end - 1 : m])
        before = np.minimum(before, sums[here - m - 2 : end - m - 2 : m])
        first = (low - 1) * m + s - low - 1
        sums[here:end:m] = before + costs[first : first + (high - low) * (m - 1) + 1 : m - 1]
    return total
