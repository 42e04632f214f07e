"""The quadratic program of one step: optimality conditions on random problems, convex and not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from canal.errors import InputError
from diagrams.ik_quadratic import BoxQuadraticProgram

N = 6


def problem(seed: int, convex: bool) -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(N, N))
    H = A @ A.T * 10.0 ** rng.uniform(-3, 3) + 0.05 * np.eye(N) if convex else A + A.T
    return H, rng.normal(size=N) * 10.0 ** rng.uniform(-2, 2), -rng.uniform(0, 1, N), rng.uniform(0, 1, N)


def assert_stationary(
    H: np.ndarray, g: np.ndarray, lower: np.ndarray, upper: np.ndarray, step: np.ndarray, active: np.ndarray
) -> None:
    assert np.all(step >= lower)
    assert np.all(step <= upper)
    slope = g + H @ step
    scale = 1e-9 * (np.abs(g).max() + np.abs(H).max())
    assert np.all(np.abs(slope[~active]) < scale)
    assert np.all(slope[active & (step == lower)] > -scale)
    assert np.all(slope[active & (step == upper)] < scale)


@given(st.integers(0, 10**6))
def test_convex_step_satisfies_the_optimality_conditions(seed: int) -> None:
    H, g, lower, upper = problem(seed, convex=True)
    step, active = BoxQuadraticProgram(N, ["clarabel"]).solve(H, g, lower, upper)
    assert_stationary(H, g, lower, upper, step, active)


@given(st.integers(0, 10**6))
def test_descent_finds_a_local_minimum_of_any_quadratic(seed: int) -> None:
    H, g, lower, upper = problem(seed, convex=False)
    step, active = BoxQuadraticProgram(N, []).descend(H, g, lower, upper)
    assert_stationary(H, g, lower, upper, step, active)
    assert g @ step + 0.5 * step @ H @ step <= 1e-12
    free = H[np.ix_(~active, ~active)]
    assert not len(free) or np.linalg.eigvalsh(free)[0] > -1e-9


def test_every_way_gives_the_same_answer() -> None:
    program = BoxQuadraticProgram(N, ["clarabel", "osqp"])
    for seed in range(40):
        H, g, lower, upper = problem(seed, convex=True)
        step, _ = program.solve(H, g, lower, upper)
        for other in (program.descend(H, g, lower, upper), program._by_solver(H, g, lower, upper)):
            assert other is not None
            np.testing.assert_allclose(other[0], step, atol=1e-8)


def test_the_program_of_drake_is_reused_not_rebuilt() -> None:
    program = BoxQuadraticProgram(N, ["clarabel", "osqp"])
    drake_program = program.program
    for seed in range(5):
        program._by_solver(*problem(seed, convex=True))
    assert program.program is drake_program
    assert len(drake_program.quadratic_costs()) == len(drake_program.bounding_box_constraints()) == 1
    H, g, lower, upper = problem(4, convex=True)
    cost, box = drake_program.quadratic_costs()[0].evaluator(), drake_program.bounding_box_constraints()[0].evaluator()
    np.testing.assert_array_equal(cost.Q(), H)
    np.testing.assert_array_equal(cost.b(), g)
    np.testing.assert_array_equal(box.lower_bound(), lower)
    np.testing.assert_array_equal(box.upper_bound(), upper)


def test_remaining_gain_is_zero_at_the_minimum_and_infinite_when_a_bound_lets_go() -> None:
    program = BoxQuadraticProgram(N, [])
    H = np.diag(np.arange(1.0, 7.0))
    lower, upper = -np.ones(N), np.ones(N)
    _, active = program.solve(H, np.array([0.5, -9.0, 0.0, 0.0, 0.0, 0.0]), lower, upper)
    np.testing.assert_array_equal(active, [False, True, False, False, False, False])
    slope = np.array([0.0, -7.0, 0.0, 0.0, 0.0, 0.0])
    assert program.remaining(slope) == 0.0
    assert program.remaining(-slope) == np.inf
    assert program.remaining(slope + np.array([0.2, 0, 0, 0, 0, 0])) == pytest.approx(0.02)


def test_an_indefinite_matrix_is_reported_and_an_unknown_solver_refused() -> None:
    program = BoxQuadraticProgram(2, [])
    assert program.solve(np.diag([1.0, -1.0]), np.ones(2), -np.ones(2), np.ones(2)) is None
    with pytest.raises(InputError, match="clarabel, osqp"):
        BoxQuadraticProgram(2, ["gurobi2"])
