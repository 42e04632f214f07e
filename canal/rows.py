"""Rows of samples: how long a polyline is up to each of its points, and what lies between its samples."""

import numpy as np


def accumulate(steps: np.ndarray) -> np.ndarray:
    """From n - 1 steps to n sums, of which the first is 0. Shape (n,)."""
    return np.concatenate([[0.0], np.cumsum(steps)])


def length_along(points: np.ndarray) -> np.ndarray:
    """Length of a polyline (n, k) up to each of its points, in the unit of the points. Shape (n,)."""
    return accumulate(np.linalg.norm(np.diff(points, axis=0), axis=1))


def rows_between(rows: np.ndarray, at: np.ndarray, grid: np.ndarray | None = None) -> np.ndarray:
    """Each column of a table, linearly between its rows; beyond the first and the last row, those.

    Args:
        rows: the table. Shape (n, k).
        at: where the columns are wanted. Shape (m,).
        grid: where the rows are, ascending; None: at 0 to n - 1. Shape (n,).

    Returns:
        Shape (m, k).
    """
    grid = np.arange(len(rows), dtype=float) if grid is None else grid
    return np.column_stack([np.interp(at, grid, column) for column in rows.T])
