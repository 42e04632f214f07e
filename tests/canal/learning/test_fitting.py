"""Curves follow the shape of a demonstration; when it was where moves them little."""

import numpy as np
import pytest
from hard_demonstrations import hard_demonstrations

from canal.learning import splines
from canal.learning.alignment import align, evenly_moving
from canal.learning.splines import fit_spline, knots_every
from canal.learning.trimming import ROTATION_LENGTH_M, trim
from canal.rows import rows_between

KNOTS = knots_every(0.1)
U = np.linspace(0.0, 1.0, 201)


def arc(u: np.ndarray) -> np.ndarray:
    """Half of a circle of radius 0.5 m, once round by a half."""
    return 0.5 * np.column_stack([np.cos(np.pi * u), np.sin(np.pi * u), 0 * u])


def hesitant(u: np.ndarray) -> np.ndarray:
    """The same way, with 60 mm too far and back again in the middle of it."""
    return arc(u + 0.04 * np.exp(-(((u - 0.45) / 0.02) ** 2)) - 0.04 * np.exp(-(((u - 0.55) / 0.02) ** 2)))


def off_the_circle() -> float:
    points = fit_spline(KNOTS, hesitant(U), interpolate=False)(np.linspace(0, 1, 1000))
    return float(np.abs(np.linalg.norm(points, axis=1) - 0.5).max())


def test_a_hesitation_along_the_way_does_not_bend_it(monkeypatch):
    away = off_the_circle()
    assert away < 0.002
    monkeypatch.setattr(splines, "TIMING_WEIGHT", 1.0)
    assert away < 0.5 * off_the_circle()


def test_a_curve_of_the_family_is_met_exactly():
    wanted = fit_spline(KNOTS, arc(U), interpolate=True)
    assert np.abs(fit_spline(KNOTS, wanted(U), interpolate=False)(U) - wanted(U)).max() < 1e-12


def test_samples_on_one_point_for_a_while_are_fitted():
    stands = arc(np.clip(2 * U - 0.5, 0.0, 1.0))
    curve = fit_spline(KNOTS, stands, interpolate=False)
    assert np.isfinite(curve(U)).all()
    assert curve(U)[[0, -1]] == pytest.approx(stands[[0, -1]], abs=1e-12)


@pytest.mark.parametrize("n", [2, 4])
def test_the_common_parameter_is_even_in_what_all_move(n):
    motions = [trim(d, 201) for d in hard_demonstrations(7, n)]
    warps = align(motions)

    def steps(warps: np.ndarray) -> np.ndarray:
        squared = np.zeros(200)
        for motion, warp in zip(motions, warps, strict=True):
            moved, turned = (
                np.diff(rows_between(motion.position, warp), axis=0),
                np.diff(rows_between(motion.orientation, warp), axis=0),
            )
            squared += np.sum(moved**2, axis=1) + (2 * ROTATION_LENGTH_M) ** 2 * np.sum(turned**2, axis=1)
        return np.sqrt(squared)

    even = evenly_moving(motions, warps)
    assert (np.diff(even, axis=1) >= 0).all()
    assert even[:, 0] == pytest.approx(np.zeros(n), abs=1e-9)
    assert even[:, -1] == pytest.approx(np.full(n, 200.0), abs=1e-9)
    assert np.std(steps(even)) < 0.2 * np.std(steps(warps))
    # What is paired stays paired: each warp is still the same function of the first.
    assert np.interp(even[0], warps[0], warps[1]) == pytest.approx(even[1], abs=0.1)
