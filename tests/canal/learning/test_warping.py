"""The warping path: within its band, monotone, the same however the curves are turned."""

import numpy as np
from scipy.spatial.transform import Rotation

from canal.learning.warping import warping_path


def test_path_stays_in_its_band():
    late = np.zeros((60, 3))
    late[40:, 0] = 1.0
    path = warping_path(late, late[::-1] + [1.0, 0, 0], 0.1)
    assert np.abs(path[:, 0] - path[:, 1]).max() <= 6
    assert (path[0] == 0).all()
    assert (path[-1] == 59).all()
    assert set(map(tuple, np.diff(path, axis=0))) <= {(1, 1), (1, 0), (0, 1)}


def test_ways_that_are_equally_long_are_told_apart_alike_after_a_turn():
    # On a lattice many ways are equally long.
    rng = np.random.default_rng(3)
    a, b = 0.25 * rng.integers(-3, 4, (2, 40, 3))
    R, p = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    assert np.array_equal(warping_path(a, b, 0.15), warping_path(a @ R.T + p, b @ R.T + p, 0.15))
