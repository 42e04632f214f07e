"""Frames against closed forms (line, circle, helix) and by their laws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from canal.learning.disk_normals import continuous_directions
from canal.learning.frames import bishop_frames, correction_frames, frenet_frames, perpendicular, project

X = np.array([1.0, 0, 0])


def helix(radius, pitch, turns, n):
    """Points, first and second derivatives, curvature, torsion of (a cos u, a sin u, b u)."""
    u = np.linspace(0, 2 * np.pi * turns, n)
    a, b = radius, pitch / (2 * np.pi)
    points = np.column_stack([a * np.cos(u), a * np.sin(u), b * u])
    first = np.column_stack([-a * np.sin(u), a * np.cos(u), np.full(n, b)])
    second = np.column_stack([-a * np.cos(u), -a * np.sin(u), np.zeros(n)])
    square = a * a + b * b
    return u, points, first, second, a / square, b / square


def random_curve(seed, n=240):
    rng = np.random.default_rng(seed)
    u = np.linspace(0, 1, n)[:, None]
    waves = sum(rng.normal(size=3) * np.sin(np.pi * k * u + rng.uniform(0, 6)) / k**1.5 for k in range(1, 4))
    points = 0.2 * waves + u * rng.normal(size=3)
    tangents = np.gradient(points, axis=0)
    return points, tangents / np.linalg.norm(tangents, axis=1, keepdims=True)


def test_frenet_of_a_helix_is_exact():
    u, _, first, second, kappa, _ = helix(0.3, 0.5, 1.7, 200)
    tangent, normal, binormal, curvature = frenet_frames(first, second)
    assert np.abs(curvature - kappa).max() < 1e-12
    assert np.abs(normal + np.column_stack([np.cos(u), np.sin(u), 0 * u])).max() < 1e-12
    assert np.abs(binormal - np.cross(tangent, normal)).max() < 1e-12


def test_frenet_of_a_circle_is_exact():
    _u, points, first, second, _kappa, _ = helix(0.4, 0.0, 1, 100)
    _tangent, normal, binormal, curvature = frenet_frames(first, second)
    assert np.abs(curvature - 1 / 0.4).max() < 1e-12
    assert np.abs(normal + points / 0.4).max() < 1e-12
    assert np.abs(binormal - [0, 0, 1]).max() < 1e-12


def test_frenet_of_a_line_is_some_constant_frame():
    tangent, normal, _binormal, curvature = frenet_frames(np.tile([2.0, 1, 0], (50, 1)), np.zeros((50, 3)))
    assert curvature.max() == 0
    assert np.ptp(normal, axis=0).max() < 1e-14
    assert np.abs(np.sum(normal * tangent, axis=1)).max() < 1e-14


def test_bishop_turns_back_by_the_torsion_of_a_helix():
    # The angle of the Frenet normal in a rotation-minimising frame grows by ∫ τ ds, which is known.
    n = 400
    u, points, first, second, kappa, tau = helix(0.3, 0.5, 2, n)
    tangent, normal, binormal, _ = frenet_frames(first, second)
    b1, b2 = bishop_frames(points, tangent, normal[0])
    angle = np.unwrap(np.arctan2(np.sum(normal * b2, axis=1), np.sum(normal * b1, axis=1)))
    expected = tau * u / np.sqrt(kappa**2 + tau**2) * np.sqrt(kappa**2 + tau**2) * np.linalg.norm(first[0])
    # Double reflection is of fourth order in the step globally.
    step = np.linalg.norm(first[0]) * (u[1] - u[0])
    assert np.abs(angle - expected).max() < 20 * step**4
    coarse = bishop_frames(points[::2], tangent[::2], normal[0])[0]
    error_coarse = np.linalg.norm(coarse[-1] - np.cos(expected[-2]) * normal[-2] + np.sin(expected[-2]) * binormal[-2])
    error_fine = np.linalg.norm(b1[-1] - np.cos(expected[-1]) * normal[-1] + np.sin(expected[-1]) * binormal[-1])
    assert error_coarse > 10 * error_fine


def test_bishop_of_a_plane_curve_keeps_the_planes_normal():
    _, points, first, _, _, _ = helix(0.3, 0.0, 0.9, 150)
    tangent = first / np.linalg.norm(first, axis=1, keepdims=True)
    b1, _ = bishop_frames(points, tangent, np.array([0.0, 0, 1]))
    assert np.abs(b1 - [0, 0, 1]).max() < 1e-12


@given(st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_bishop_frames_are_orthonormal_and_turn_no_more_than_they_must(seed):
    points, tangents = random_curve(seed)
    b1, b2 = bishop_frames(points, tangents, X)
    frame = np.stack([tangents, b1, b2], axis=1)
    assert np.abs(frame @ frame.transpose(0, 2, 1) - np.eye(3)).max() < 1e-12
    # Minimal: no turn about the tangent, up to the third order of the step.
    turn = Rotation.from_matrix(frame[1:].transpose(0, 2, 1) @ frame[:-1]).as_rotvec()
    mean = tangents[1:] + tangents[:-1]
    mean /= np.linalg.norm(mean, axis=1, keepdims=True)
    about = np.abs(np.sum(turn * mean, axis=1))
    bend = np.linalg.norm(np.diff(tangents, axis=0), axis=1)
    assert (about <= 0.02 * bend + 1e-9).all()


@given(st.integers(0, 10_000), st.floats(0.0, 0.2))
@settings(max_examples=60, deadline=None)
def test_correction_frames_hold_their_laws(seed, radius):
    points, tangents = random_curve(seed)
    normals = continuous_directions(tangents)
    radii = np.full(len(points), radius)
    x, y = correction_frames(points, normals, radii, X, start=perpendicular(normals[0]))
    for axis in (x, y):
        assert np.abs(np.linalg.norm(axis, axis=1) - 1).max() < 1e-12
        assert np.abs(np.sum(axis * normals, axis=1)).max() < 1e-12
        assert (np.sum(axis[1:] * axis[:-1], axis=1) > 0).all()
    assert np.abs(np.sum(x * y, axis=1)).max() < 1e-12
    # The twist: what x turns about n beyond its projection.
    carried = np.array([project(x[s - 1], normals[s]) for s in range(1, len(x))])
    # A frame that was carried back from the first well-posed disk keeps the bound the other way round.
    twist = np.arccos(np.clip(np.sum(carried * x[1:], axis=1), -1, 1))
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    bend = np.linalg.norm(np.diff(normals, axis=0), axis=1)
    assert (radius * twist <= steps * (1 + 1e-6) + radius * (1e-6 + bend**2)).all()


def test_correction_x_is_the_projection_of_x_global_where_that_is_plain():
    points = np.column_stack([np.zeros(40), np.linspace(0, 1, 40), np.zeros(40)])
    normals = np.tile([0.0, 1, 0], (40, 1))
    x, y = correction_frames(points, normals, np.full(40, 0.1), X, start=X)
    assert np.abs(x - X).max() < 1e-15
    assert np.abs(y - [0, 0, -1]).max() < 1e-15


def test_a_path_along_x_global_starts_where_it_is_told():
    points = np.column_stack([np.linspace(0, 1, 40), np.zeros(40), np.zeros(40)])
    normals = np.tile(X, (40, 1))
    x, _ = correction_frames(points, normals, np.full(40, 0.1), X, start=np.array([0.3, 0, 1.0]))
    assert np.abs(x - [0, 0, 1]).max() < 1e-15


def test_a_path_that_starts_along_x_global_is_continuous_up_to_where_x_says_something():
    u = np.linspace(0, np.pi / 2, 80)
    points = np.column_stack([np.sin(u), 1 - np.cos(u), 0 * u])
    normals = np.column_stack([np.cos(u), np.sin(u), 0 * u])
    x, _ = correction_frames(points, normals, np.full(80, 0.05), X, start=np.array([0, 0, 1.0]))
    assert (np.sum(x[1:] * x[:-1], axis=1) > np.cos(np.radians(8))).all()
    assert x[-1] @ X > 0.99


def test_the_window_of_the_paper_is_an_option():
    points, tangents = random_curve(3)
    normals = continuous_directions(tangents)
    radii = np.full(len(points), 0.05)
    near = correction_frames(points, normals, radii, X, start=X)
    wide = correction_frames(points, normals, radii, X, start=X, y_window=10)
    assert np.array_equal(near[0], wide[0])
    assert np.allclose(np.abs(np.sum(near[1] * wide[1], axis=1)), 1)


@pytest.mark.parametrize("vector", np.eye(3))
def test_perpendicular_and_project_never_fail(vector):
    assert abs(perpendicular(vector) @ vector) < 1e-15
    assert abs(project(vector, vector) @ vector) < 1e-15
