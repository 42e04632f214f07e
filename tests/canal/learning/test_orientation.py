import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyquaternion import Quaternion
from scipy.spatial.transform import Rotation

from canal.learning.orientation import agree_in_sign, mean_orientation, orientation_spread, orientation_weight
from canal.learning.splines import rotation_curve
from canal.learning.trimming import continuous_signs


def some_quaternions(seed, n, size, spread=0.6):
    rng = np.random.default_rng(seed)
    base = Rotation.random(random_state=np.random.RandomState(seed))
    turns = Rotation.from_rotvec(rng.normal(size=(n * size, 3)) * spread / np.sqrt(3))
    return (base * turns).as_quat(scalar_first=True).reshape(n, size, 4)


@given(st.integers(0, 1000), st.integers(2, 6))
@settings(max_examples=30, deadline=None)
def test_mean_and_spread_are_scipys_and_pyquaternions(seed, n):
    quaternions = some_quaternions(seed, n, 5)
    mean = mean_orientation(quaternions)
    spread = orientation_spread(quaternions, mean)
    for s in range(5):
        expected = Rotation.from_quat(quaternions[:, s], scalar_first=True).mean().as_quat(scalar_first=True)
        assert abs(mean[s] @ expected) == pytest.approx(1, abs=1e-12)
        distances = [Quaternion.absolute_distance(Quaternion(*q), Quaternion(*mean[s])) for q in quaternions[:, s]]
        assert spread[s] == pytest.approx(np.sqrt(np.mean(np.square(distances))), abs=1e-9)


def test_signs_change_no_mean():
    quaternions = some_quaternions(1, 3, 20, 0.3)
    flipped = quaternions * np.where(np.random.default_rng(0).random((3, 20, 1)) < 0.5, -1, 1)
    assert np.abs(np.abs(np.sum(mean_orientation(quaternions) * mean_orientation(flipped), axis=1)) - 1).max() < 1e-12


def test_the_weight_is_the_papers():
    assert orientation_weight(np.array([0.0, 0.3])) == pytest.approx([np.exp(2.7), 1.0])
    assert orientation_weight(np.array([0.0]))[0] == pytest.approx(15, rel=0.01)


def test_signs_agree_along_and_between():
    quaternions = some_quaternions(2, 3, 1, 0.2).repeat(30, axis=1)
    flipped = quaternions * np.where(np.random.default_rng(0).random((3, 30, 1)) < 0.5, -1, 1)
    agreed = agree_in_sign(flipped)
    assert (np.sum(agreed[:, 1:] * agreed[:, :-1], axis=2) > 0).all()
    assert (np.sum(agreed[1:] * agreed[0], axis=2) > 0).all()


def test_catmull_rom_passes_its_knots_smoothly_and_turns_at_a_constant_rate_where_they_do():
    knots = np.linspace(0, 1, 6)
    turns = Rotation.from_rotvec(np.outer(knots, [0.4, 1.0, -0.3])).as_quat(scalar_first=True)
    at = np.linspace(0, 1, 101)
    found = rotation_curve(knots, turns, at)
    expected = Rotation.from_rotvec(np.outer(at, [0.4, 1.0, -0.3])).as_quat(scalar_first=True)
    # Natural ends bend the first and the last segment.
    assert np.abs(np.abs(np.sum(found * expected, axis=1)) - 1)[20:81].max() < 1e-12
    wild = continuous_signs(some_quaternions(5, 1, 6, 1.0)[0])
    curve = rotation_curve(knots, wild, at)
    assert np.abs(np.abs(np.sum(curve[::20] * wild, axis=1)) - 1).max() < 1e-12
    assert np.linalg.norm(np.diff(curve, axis=0), axis=1).max() < 0.2
