"""The solver on ordinary and on the worst of arguments: optimal, finite, within every bound, continuous."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ik_arm import Q_START, TCP, lio_plant, pose_of
from scipy.spatial.transform import Rotation

from canal.errors import InputError
from diagrams.ik.options import IkOptions, IkStatus
from diagrams.ik.solver import IkResult, IkSolver

DT = 0.01
EXCESS = 1e-12


@pytest.fixture(scope="module")
def solver() -> IkSolver:
    return IkSolver(lio_plant(), TCP)


def assert_safe(solver: IkSolver, result: IkResult, q_prev: np.ndarray, dt: float) -> None:
    """Finite, no step above v dt, and within the limits or coming back to them as fast as it may."""
    assert np.all(np.isfinite(result.q))
    assert np.all(np.abs(result.q - q_prev) <= solver.v_max * dt + EXCESS)
    outside_before = np.maximum(0.0, np.maximum(solver.q_min - q_prev, q_prev - solver.q_max))
    outside = np.maximum(0.0, np.maximum(solver.q_min - result.q, result.q - solver.q_max))
    assert np.all(outside <= np.maximum(outside_before - solver.v_max * dt, 0.0) + EXCESS)


def best_of_many_starts(
    solver: IkSolver, X: np.ndarray, w: float, q_prev: np.ndarray, rng: np.random.Generator
) -> float:
    """The lowest cost of the tick that scipy's L-BFGS-B finds from ten starts on the same objective."""
    from scipy.optimize import minimize

    from diagrams.ik.target import wanted_pose

    target = wanted_pose(X)
    assert target is not None
    lower, upper = solver.box(q_prev, DT)

    def both(q: np.ndarray) -> tuple[float, np.ndarray]:
        value = solver.objective.value(np.clip(q, lower, upper))
        return value, solver.objective.gradient()

    solver.objective.set_target(*target, w, q_prev)
    starts = [q_prev, *rng.uniform(lower, upper, size=(9, 6))]
    options = {"ftol": 1e-15, "gtol": 1e-12, "maxiter": 500}
    return min(
        minimize(both, q, jac=True, bounds=list(zip(lower, upper, strict=True)), options=options).fun for q in starts
    )


@pytest.mark.parametrize("w", [0.1, 1.0, 15.0])
def test_no_other_method_finds_a_better_posture(solver: IkSolver, w: float) -> None:
    rng = np.random.default_rng(5)
    for _ in range(8):
        q_prev = rng.uniform(0.8 * solver.q_min, 0.8 * solver.q_max)
        X = pose_of(solver, q_prev + rng.normal(scale=0.01, size=6))
        result = solver.solve(X, w, q_prev, DT)
        best = best_of_many_starts(solver, X, w, q_prev, rng)
        assert result.cost - best <= 1e-6 * max(best, 1e-9)


def test_tracks_a_path_of_postures_exactly(solver: IkSolver) -> None:
    times = np.arange(0.0, 3.0, DT)
    swing = np.array([0.5, 0.2, -0.3, 0.6, -0.2, 0.8])
    q, v = Q_START, np.zeros(6)
    for t in times:
        X = pose_of(solver, Q_START + swing * (1.0 - np.cos(t)))
        result = solver.solve(X, 15.0, q, DT, v)
        assert result.status == IkStatus.CONVERGED
        assert result.position_error < 1e-4
        assert result.orientation_error < np.radians(0.1)
        q, v = result.q, (result.q - q) / DT


def test_statuses_say_how_a_tick_ended(solver: IkSolver) -> None:
    X = pose_of(solver, Q_START + 0.001)
    assert solver.solve(X, 1.0, Q_START, DT).status == IkStatus.CONVERGED
    assert solver.solve(pose_of(solver, Q_START + 0.5), 1.0, Q_START, DT).status == IkStatus.AT_BOUND
    far = np.array([0.0, 3.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    q, status = Q_START, None
    for _ in range(400):
        q, status, *_ = solver.solve(far, 0.1, q, DT)
    assert status == IkStatus.OUT_OF_REACH
    held = solver.solve(np.full(7, np.nan), 1.0, q, DT)
    assert held.status == IkStatus.HELD
    np.testing.assert_array_equal(held.q, q)


BAD_VALUES = [np.nan, np.inf, -np.inf, 1e300, -1e300]


@pytest.mark.parametrize("bad", BAD_VALUES)
def test_bad_values_in_each_argument_hold_or_are_survived(solver: IkSolver, bad: float) -> None:
    X = pose_of(solver, Q_START + 0.01)
    for index in range(7):
        worse = X.copy()
        worse[index] = bad
        assert_safe(solver, solver.solve(worse, 1.0, Q_START, DT), Q_START, DT)
    assert_safe(solver, solver.solve(X, bad, Q_START, DT), Q_START, DT)
    assert_safe(solver, solver.solve(X, 1.0, Q_START, DT, np.array([0, bad, 0, 0, 0, 0])), Q_START, DT)
    assert_safe(solver, solver.solve(X, np.array([bad]), Q_START, DT), Q_START, DT)
    q_bad = Q_START.copy()
    q_bad[2] = bad
    assert np.all(np.isfinite(solver.solve(X, 1.0, q_bad, DT).q))
    result = solver.solve(X, 1.0, Q_START, bad)
    assert np.all(np.isfinite(result.q))
    assert np.all((result.q >= solver.q_min) & (result.q <= solver.q_max))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_holds(solver: IkSolver, bad: float) -> None:
    X = pose_of(solver, Q_START + 0.01)
    worse = X.copy()
    worse[4] = bad
    for result in (
        solver.solve(worse, 1.0, Q_START, DT),
        solver.solve(X, bad, Q_START, DT),
        solver.solve(X, 1.0, Q_START, bad),
        solver.solve(np.concatenate((X[:3], np.zeros(4))), 1.0, Q_START, DT),
    ):
        assert result.status == IkStatus.HELD
        np.testing.assert_array_equal(result.q, Q_START)


@pytest.mark.parametrize("w", [0.0, 1e6, -1.0])
def test_extreme_weights_are_safe(solver: IkSolver, w: float) -> None:
    q = Q_START
    X = pose_of(solver, Q_START + 0.4)
    for _ in range(100):
        result = solver.solve(X, w, q, DT)
        assert_safe(solver, result, q, DT)
        q = result.q
    assert result.position_error < (1e-3 if w <= 0.0 else 0.05)
    if w > 1.0:
        assert result.orientation_error < 1e-3


def adversarial_targets() -> dict[str, list[np.ndarray]]:
    """Paths of 200 targets each, by name."""
    down, ticks = np.array([0.0, 1.0, 0.0, 0.0]), 200

    def spin(t: float) -> np.ndarray:
        return Rotation.from_euler("y", 360.0 * t, degrees=True).as_quat(scalar_first=True)

    rng = np.random.default_rng(6)
    jumps = [np.concatenate((rng.normal(size=3), rng.normal(size=4))) for _ in range(8)]
    return {
        "2 m out of reach": [np.array([0.0, 3.0, 1.0, *down])] * ticks,
        "straight up": [np.array([0.0, 0.0, 1.6445 + 1e-4 * k, 0.0, 1.0, 1.0, 0.0]) for k in range(ticks)],
        "straight down": [np.array([1e-3, 1e-3, 0.1, *down])] * ticks,
        "through the axis of joint 1": [np.array([0.3 - 0.003 * k, 0.0, 1.0, *down]) for k in range(ticks)],
        "360° spin": [np.array([0.17, 0.0, 1.05, *spin(k / ticks)]) for k in range(ticks)],
        "180° jumps": [np.array([0.17, 0.0, 1.05, *spin(0.5 * (k // 20))]) for k in range(ticks)],
        "random jumps": [jumps[k // 25] for k in range(ticks)],
    }


@pytest.mark.parametrize("w", [0.1, 15.0, 1e6])
@pytest.mark.parametrize("name", list(adversarial_targets()))
def test_adversarial_paths_are_survived(solver: IkSolver, name: str, w: float) -> None:
    starts = {
        "the usual": Q_START,
        "stretched": np.zeros(6),
        "wrist singular": np.array([0.0, 0.5, 0.5, 0.0, 0.0, 0.0]),
        "at the limits": solver.q_max,
        "outside the limits": solver.q_max + 0.3,
    }
    for start in starts.values():
        q, v = start, np.zeros(6)
        for X in adversarial_targets()[name][::4]:
            result = solver.solve(X, w, q, DT, v)
            assert_safe(solver, result, q, DT)
            assert result.status != IkStatus.HELD
            q, v = result.q, (result.q - q) / DT


def test_at_rest_the_answer_is_the_last_posture_bit_for_bit(solver: IkSolver) -> None:
    for w, X in itertools.product((0.1, 15.0), (pose_of(solver, Q_START + 0.2), np.array([0.0, 3, 1, 1, 0, 0, 0]))):
        q, v = Q_START, np.zeros(6)
        for _ in range(3000):
            result = solver.solve(X, w, q, DT, v)
            q, v = result.q, (result.q - q) / DT
            if not v.any():
                break
            assert np.abs(v).max() * DT >= 1e-9
        assert not v.any()
        for _ in range(20):
            np.testing.assert_array_equal(solver.solve(X, w, q, DT, v).q, q)


def test_start_outside_the_limits_comes_back_at_the_allowed_speed(solver: IkSolver) -> None:
    q = solver.q_max + 0.1
    X = pose_of(solver, Q_START)
    ticks = int(np.ceil(0.1 / (solver.v_max[0] * DT)))
    for _ in range(ticks):
        q = solver.solve(X, 1.0, q, DT).q
    assert np.all(q <= solver.q_max)


POSE = st.lists(st.one_of(st.floats(-2, 2), st.floats(allow_nan=True, allow_infinity=True)), min_size=7, max_size=7)


@settings(max_examples=300, deadline=None)
@given(POSE, st.floats(), st.lists(st.floats(-4, 4), min_size=6, max_size=6), st.floats(1e-4, 1.0))
def test_fuzzed_ticks_are_safe(X: list[float], w: float, q: list[float], dt: float) -> None:
    solver = FUZZED
    q_prev = np.array(q)
    assert_safe(solver, solver.solve(np.array(X), w, q_prev, dt), q_prev, dt)


FUZZED = IkSolver(lio_plant(), TCP)


def test_soft_limits_lie_inside_the_models() -> None:
    solver = IkSolver(lio_plant(), TCP, IkOptions(soft_limit_margin=0.05))
    hard = IkSolver(lio_plant(), TCP)
    np.testing.assert_allclose(solver.q_max, hard.q_max - 0.05)
    q = Q_START
    for _ in range(300):
        q = solver.solve(np.array([-0.5, -0.5, 0.3, 1.0, 0.0, 0.0, 0.0]), 15.0, q, DT).q
    assert np.all((q >= solver.q_min - EXCESS) & (q <= solver.q_max + EXCESS))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"soft_limit_margin": 4.0}, "soft_limit_margin 4"),
        ({"soft_limit_margin": -0.2}, r"ik\.soft_limit_margin is -0\.2; give a number of 0 or more"),
        ({"speed_limits": [1.0]}, "6 positive values"),
        ({"speed_limits": [0.0] * 6}, r"ik\.speed_limits\[0\] is 0\.0; give a number above 0"),
        ({"position_weight": math.nan}, r"ik\.position_weight is nan; give a finite number"),
    ],
)
def test_options_that_cannot_be_used_are_refused(options: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        IkSolver(lio_plant(), TCP, IkOptions(**options))
