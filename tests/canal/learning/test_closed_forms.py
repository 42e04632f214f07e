"""Canals whose shape is known: half a torus, a straight tube."""

import numpy as np
import pytest
from canals import exact

from canal.learning import build_surface, learn_canal
from canal.learning_options import LearningOptions
from canal.quality import curvature

BIG, SMALL = 0.4, 0.06


def test_a_torus_canal_is_learned_to_the_order_of_its_splines():
    # Two coaxial arcs of radius R ± r in one plane: the canal is half a torus. Cubics with ten knots, and natural
    # ends, which are straight: their error fades by a factor of four per knot.
    def arc(sign):
        return lambda u: [(BIG + sign * SMALL) * np.cos(np.pi * u), (BIG + sign * SMALL) * np.sin(np.pi * u), 0.5]

    canal = learn_canal(exact([arc(-1), arc(1)]))
    middle = slice(60, -60)
    to_axis = np.linalg.norm(canal.directrix[:, :2], axis=1)
    assert np.abs(to_axis - BIG)[middle].max() < 6e-4
    assert np.abs(to_axis - BIG).max() < 2e-3
    assert np.abs(canal.radii - SMALL).max() < 3e-4
    assert np.abs(curvature(canal) - 1 / BIG)[middle].max() < 0.2
    assert canal.length == pytest.approx(np.pi * BIG, rel=2e-3)


@pytest.mark.parametrize("n", [4, 5])
def test_the_surface_around_an_exact_torus_is_exact(n):
    theta = np.linspace(0, np.pi, 301)
    outward = np.column_stack([np.cos(theta), np.sin(theta), 0 * theta])
    tangent = np.column_stack([-np.sin(theta), np.cos(theta), 0 * theta])
    around = 2 * np.pi * np.arange(n) / n
    positions = np.stack(
        [BIG * outward + SMALL * (np.cos(a) * outward + np.sin(a) * np.array([0, 0, 1.0])) for a in around]
    )
    quaternions = np.tile([1.0, 0, 0, 0], (n, 301, 1))
    options = LearningOptions(x_global=(0, 0, 1))
    canal = build_surface(positions, quaternions, tangents=tangent, moving_time_s=10.0, options=options)
    assert np.abs(canal.directrix - BIG * outward).max() < 1e-12
    assert np.abs(canal.radii - SMALL).max() < 1e-12
    assert np.array_equal(canal.normals, tangent)
    assert np.abs(canal.x_axes - [0, 0, 1]).max() < 1e-12
    assert np.abs(canal.y_axes - outward).max() < 1e-12
    # A point of the canal is a point of the torus.
    for s, phi in ((0, 0.3), (77, -2.0), (300, 3.0)):
        x, y, z = canal.point(s, 1.0, phi)
        assert (np.hypot(x, y) - BIG) ** 2 + z**2 == pytest.approx(SMALL**2, abs=1e-12)
    # Curvature from chords is of second order in the step.
    assert np.abs(curvature(canal) - 1 / BIG).max() < 0.1 * (np.pi / 300) ** 2 * 10


def test_a_straight_line_along_x_global_has_defined_frames():
    lines = [lambda u, k=k: [0.2 + 0.5 * u, 0.05 * k, 0.6] for k in (-1, 1)]
    canal = learn_canal(exact(lines))
    assert np.abs(canal.tangents - [1, 0, 0]).max() < 1e-9
    assert canal.radii == pytest.approx(0.05, abs=1e-9)
    assert np.ptp(canal.x_axes, axis=0).max() < 1e-9
