from dataclasses import replace

import numpy as np
import pytest
from canals import elliptic_canal
from hard_demonstrations import hard_demonstrations
from hypothesis import given, settings
from hypothesis import strategies as st

from canal.learning import learn_canal
from canal.learning.ellipses import disk_ellipses
from canal.learning_options import LearningOptions
from canal.quality import canal_quality, step_ratio


def reaches(canal):
    """Projected demonstrations on their disks, relative to the ellipse's rim. Shape (n, N)."""
    offsets = canal.demonstrations - canal.directrix
    u = np.sum(offsets * canal.x_axes, axis=2)
    v = np.sum(offsets * canal.y_axes, axis=2)
    a, b, angle = canal.ellipses.T
    along, across = np.cos(angle) * u + np.sin(angle) * v, -np.sin(angle) * u + np.cos(angle) * v
    return np.hypot(along / np.maximum(a, 1e-12), across / np.maximum(b, 1e-12))


@pytest.mark.parametrize("n", [3, 4, 7])
def test_ellipses_hold_the_data_and_lie_in_the_circle(n):
    canal = elliptic_canal(3, n)
    assert reaches(canal).max() <= 1 + 1e-9
    a, b, angle = canal.ellipses.T
    assert (a <= canal.radii + 1e-12).all()
    assert (b <= a + 1e-12).all()
    assert (b > 0).all()
    assert np.mean(a * b) < 0.9 * np.mean(canal.radii**2)
    assert (np.abs(angle) <= np.pi / 2).all()


@given(st.integers(0, 10_000), st.integers(3, 10))
@settings(max_examples=60, deadline=None)
def test_any_points_are_held(seed, n):
    rng = np.random.default_rng(seed)
    offsets = rng.normal(size=(n, 20, 3)) * rng.uniform(0.0, 0.2, 3)
    offsets -= offsets.mean(axis=0)
    radii = np.linalg.norm(offsets, axis=2).max(axis=0)
    x, y = np.tile([1.0, 0, 0], (20, 1)), np.tile([0, 1.0, 0], (20, 1))
    a, b, angle = disk_ellipses(offsets, x, y, radii).T
    along = np.cos(angle) * offsets[..., 0] + np.sin(angle) * offsets[..., 1]
    across = -np.sin(angle) * offsets[..., 0] + np.cos(angle) * offsets[..., 1]
    assert np.hypot(along / a, across / b).max() <= 1 + 1e-9
    assert (a <= radii + 1e-12).all()


def test_disks_without_extent_have_ellipses_without():
    flat = disk_ellipses(np.zeros((3, 4, 3)), np.tile([1.0, 0, 0], (4, 1)), np.tile([0, 1.0, 0], (4, 1)), np.zeros(4))
    assert np.array_equal(flat[:, :2], np.zeros((4, 2)))
    assert np.isfinite(flat).all()


def test_saturation_and_the_ratio_rule_are_the_ellipses():
    canal = elliptic_canal()
    s = canal.n_disks - 1
    a, b, angle = canal.ellipses[s]
    assert canal.extent(s, angle) == pytest.approx(a)
    assert canal.extent(s, angle + np.pi / 2) == pytest.approx(b)
    assert np.linalg.norm(canal.point(s, 0.5, angle) - canal.center(s)) == pytest.approx(a / 2)
    outside = canal.point(s, 1.0, angle + 1.0) + 0.01 * (canal.point(s, 1.0, angle + 1.0) - canal.center(s))
    assert canal.disk_coordinates(s, outside)[0] == pytest.approx(1.01)


@pytest.mark.parametrize("seed", range(6))
def test_the_rim_is_as_even_along_the_canal_as_the_circles(seed):
    canal = elliptic_canal(seed, 3 + seed)
    assert step_ratio(canal) <= 2.0
    assert step_ratio(canal) <= 1.3 * step_ratio(replace(canal, ellipses=None))
    assert canal_quality(canal).step_ratio_max == step_ratio(canal)


def test_a_margin_widens_both_axes():
    demonstrations = hard_demonstrations(3, 4)
    wide = learn_canal(demonstrations, LearningOptions(ellipse=True, margin=0.01))
    assert wide.ellipses[:, :2] - elliptic_canal().ellipses[:, :2] == pytest.approx(0.01, abs=1e-9)


def test_two_demonstrations_keep_circles_and_say_so():
    canal = learn_canal(hard_demonstrations(3, 2), LearningOptions(ellipse=True))
    assert canal.ellipses is None
    assert any("circles" in line for line in canal.warnings)
