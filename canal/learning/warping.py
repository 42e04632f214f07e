"""Dynamic time warping of two curves (paper V-A, step 2; Sakoe and Chiba 1978), by tslearn."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from scipy.spatial.distance import cdist

# Squared distances are rounded to this, [m²] (4 µm at zero): sums of them are then exact, so that a tie is a
# tie however the data are turned, and the warping path the same.
_QUANTUM = 2.0**-36


@cache
def _tslearn_path() -> Callable[..., Any]:
    """tslearn's `dtw_path_from_metric`, its just-in-time compilation off.

    On a few hundred points compiling costs 5 s and running 30 ms; the result is bitwise the same.
    """
    from numba import config

    before = getattr(config, "DISABLE_JIT", False)
    setattr(config, "DISABLE_JIT", True)  # noqa: B010 (numba sets its options when it is imported)
    try:
        from tslearn.metrics import dtw_path_from_metric
    finally:
        setattr(config, "DISABLE_JIT", before)  # noqa: B010
    found: Callable[..., Any] = dtw_path_from_metric
    return found


def warping_path(a: np.ndarray, b: np.ndarray, band: float) -> np.ndarray:
    """The pairs (i, j) from (0, 0) to (M - 1, M - 1) of least summed squared distance.

    Args:
        a: a curve, [m]. Shape (M, 3), M ≥ 2.
        b: another of as many points, [m]. Shape (M, 3).
        band: how far the path may run ahead or behind, as a share of M (Sakoe-Chiba).

    Returns:
        i and j along the path. Shape (P, 2).
    """
    squared = np.round(cdist(a, b, "sqeuclidean") / _QUANTUM) * _QUANTUM
    path, _ = _tslearn_path()(
        squared,
        metric="precomputed",
        global_constraint="sakoe_chiba",
        sakoe_chiba_radius=max(1, round(band * len(a))),
    )
    return np.array(path)
