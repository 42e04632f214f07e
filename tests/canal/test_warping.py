"""The warping path is tslearn's, pair by pair."""

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from canal.warping import warping_path


@pytest.fixture(scope="module")
def reference():
    """tslearn's path; uncompiled, since compiling takes longer than all the paths."""
    before = numba.config.DISABLE_JIT
    numba.config.DISABLE_JIT = True
    try:
        from tslearn.metrics import dtw_path_from_metric
    finally:
        numba.config.DISABLE_JIT = before

    def path(a: np.ndarray, b: np.ndarray, band: float) -> np.ndarray:
        squared = np.sum((a[:, None] - b) ** 2, axis=2)
        radius = max(1, round(band * len(a)))
        squared = np.round(squared * 2.0**36) / 2.0**36
        found, _ = dtw_path_from_metric(
            squared, metric="precomputed", global_constraint="sakoe_chiba", sakoe_chiba_radius=radius
        )
        return np.array(found)

    return path


# On a grid of 0.25 m many ways are equally long: what decides between them is compared, too.
lattice = st.integers(2, 24).flatmap(
    lambda m: st.tuples(*[arrays(np.int8, (m, 3), elements=st.integers(-3, 3)).map(lambda a: 0.25 * a)] * 2)
)


@given(lattice, st.sampled_from([0.05, 0.15, 0.4, 1.0]))
@settings(max_examples=150, deadline=None)
def test_path_is_the_library_s_where_ways_are_equally_long(reference, curves, band):
    assert np.array_equal(warping_path(*curves, band), reference(*curves, band))


@pytest.mark.parametrize("seed", range(5))
def test_path_is_the_library_s_on_wandering_curves(reference, seed):
    rng = np.random.default_rng(seed)
    a = np.cumsum(rng.normal(size=(201, 3)), axis=0) * 0.01
    b = a[np.sort(rng.integers(0, 201, 201))] + 0.005 * rng.normal(size=a.shape)
    assert np.array_equal(warping_path(a, b, 0.15), reference(a, b, 0.15))


def test_path_stays_in_its_band():
    late = np.zeros((60, 3))
    late[40:, 0] = 1.0
    path = warping_path(late, late[::-1] + [1.0, 0, 0], 0.1)
    assert np.abs(path[:, 0] - path[:, 1]).max() <= 6
    assert (path[0] == 0).all()
    assert (path[-1] == 59).all()
    assert set(map(tuple, np.diff(path, axis=0))) <= {(1, 1), (1, 0), (0, 1)}
