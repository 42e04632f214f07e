"""The program of one step: optimal whoever solves it, built once, open to what a user adds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ik_arm import Q_START, TCP, lio_plant, pose_of
from pydrake.solvers import MathematicalProgram, SnoptSolver

from diagrams.ik.options import IkStatus
from diagrams.ik.program import StepProgram
from diagrams.ik.solver import IkSolver

N, DT = 6, 0.01


def problem(seed: int) -> tuple[np.ndarray, ...]:
    """H, gradient at q = 0, least and largest posture, last posture, and three rows with their least values."""
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(N, N))
    H = A @ A.T * 10.0 ** rng.uniform(-3, 3) + 0.05 * np.eye(N)
    q_prev = rng.uniform(-0.1, 0.1, N)
    g = rng.normal(size=N) * 10.0 ** rng.uniform(-2, 2)
    rows = rng.normal(size=(3, N))
    # Some posture of the box meets the rows.
    lower, upper = -rng.uniform(0.1, 1, N), rng.uniform(0.1, 1, N)
    a = rows @ (rng.uniform(lower, upper) - q_prev) - rng.uniform(0, 0.1, 3)
    return H, g, lower, upper, q_prev, rows, a


@given(st.integers(0, 10**6))
def test_within_bounds_the_step_satisfies_the_optimality_conditions(seed: int) -> None:
    H, g, lower, upper, q_prev, *_ = problem(seed)
    program = StepProgram(N)
    program.begin_tick(q_prev, lower, upper)
    step = program.solve(2.0, g, H, np.zeros(N), [])
    assert step is not None
    q, slope = step.q, g + H @ step.q
    assert np.all((q >= lower) & (q <= upper))
    scale = 1e-6 * (np.abs(g).max() + np.abs(H).max())
    assert np.all(np.abs(slope[(q > lower) & (q < upper)]) < scale)
    assert np.all(slope[q == lower] > -scale)
    assert np.all(slope[q == upper] < scale)
    assert step.cost == pytest.approx(2.0 + g @ q + 0.5 * q @ H @ q)
    free = np.linalg.solve(H, -g)
    assert program.solver_calls == int(np.any((free < lower) | (free > upper)))


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10**6))
def test_rows_are_met_as_well_as_by_another_solver(seed: int) -> None:
    H, g, lower, upper, q_prev, rows, a = problem(seed)
    program = StepProgram(N, slack_price=1e4)
    program.begin_tick(q_prev, lower, upper)
    step = program.solve(0.0, g, H, np.zeros(N), [(rows[:2], a[:2]), (rows[2:], a[2:])])
    assert step is not None
    other = MathematicalProgram()
    x = other.NewContinuousVariables(N)
    other.AddQuadraticCost(H, g, x, is_convex=True)
    other.AddBoundingBoxConstraint(lower, upper, x)
    other.AddLinearConstraint(rows, a + rows @ q_prev, np.full(3, np.inf), x)
    result = SnoptSolver().Solve(other)
    assert result.is_success()
    assert step.slack < 1e-6
    assert step.cost <= result.get_optimal_cost() + 1e-5 * (1.0 + abs(result.get_optimal_cost()))


def test_rows_that_cannot_be_met_are_missed_by_as_little_as_can_be() -> None:
    program = StepProgram(2, slack_price=1e4)
    program.begin_tick(np.zeros(2), -np.ones(2), np.ones(2))
    row = (np.array([[1.0, 0.0]]), np.array([3.0]))
    step = program.solve(0.0, np.zeros(2), np.eye(2), np.zeros(2), [row])
    assert step is not None
    np.testing.assert_allclose(step.q, [1.0, 0.0], atol=1e-6)
    assert step.slack == pytest.approx(2.0)


def test_the_program_is_built_once_and_updated() -> None:
    program = StepProgram(N)
    drake_program = program.program
    counts = len(drake_program.GetAllCosts()), len(drake_program.GetAllConstraints())
    for seed in range(5):
        H, g, lower, upper, q_prev, *_ = problem(seed)
        program.begin_tick(q_prev, lower, upper)
        program.solve(0.0, g + 1e3, H, np.zeros(N), [])
    assert program.program is drake_program
    assert program.solver_calls == 5
    assert (len(drake_program.GetAllCosts()), len(drake_program.GetAllConstraints())) == counts
    (cost,), (box,) = drake_program.quadratic_costs(), drake_program.bounding_box_constraints()
    np.testing.assert_array_equal(cost.evaluator().Q(), H)
    np.testing.assert_allclose(cost.evaluator().b(), g + 1e3 + H @ q_prev)
    np.testing.assert_array_equal(box.evaluator().lower_bound(), lower)
    np.testing.assert_array_equal(box.evaluator().upper_bound(), upper)


@pytest.fixture
def solver() -> IkSolver:
    return IkSolver(lio_plant(), TCP)


def follow(solver: IkSolver, X: np.ndarray, ticks: int = 150) -> np.ndarray:
    q, v = Q_START, np.zeros(6)
    for _ in range(ticks):
        result = solver.solve(X, 15.0, q, DT, v)
        assert result.status != IkStatus.HELD
        assert np.all(np.abs(result.q - q) <= solver.v_max * DT + 1e-12)
        q, v = result.q, (result.q - q) / DT
    return q


def test_the_solver_is_asked_where_a_bound_is_active_and_nowhere_else(solver: IkSolver) -> None:
    near, far = pose_of(solver, Q_START + 0.005), pose_of(solver, Q_START + 0.3)
    free = solver.solve(near, 15.0, Q_START, DT)
    assert (free.solver_calls, free.status) == (0, IkStatus.CONVERGED)
    bound = solver.solve(far, 15.0, Q_START, DT)
    assert bound.status == IkStatus.AT_BOUND
    assert bound.solver_calls >= 1


def test_a_users_constraint_on_a_joint_is_obeyed(solver: IkSolver) -> None:
    X = pose_of(solver, Q_START + 0.3)
    assert follow(solver, X)[0] > Q_START[0] + 0.2
    solver.program.AddBoundingBoxConstraint(-np.inf, Q_START[0] + 0.1, solver.posture[0])
    assert follow(solver, X)[0] == pytest.approx(Q_START[0] + 0.1, abs=1e-8)


def test_a_users_constraint_on_the_step_is_a_bound_on_speed(solver: IkSolver) -> None:
    slow = 0.1
    solver.program.AddBoundingBoxConstraint(-slow * DT, slow * DT, solver.step)
    q = follow(solver, pose_of(solver, Q_START + 0.3), 10)
    np.testing.assert_allclose(np.abs(q - Q_START).max(), 10 * slow * DT, atol=1e-7)


def test_a_users_cost_is_part_of_the_optimum(solver: IkSolver) -> None:
    X, wanted, weight = pose_of(solver, Q_START + 0.05), Q_START - 0.01, 3.0
    binding = solver.program.AddQuadraticErrorCost(weight * np.eye(6), wanted, solver.posture)
    result = solver.solve(X, 15.0, Q_START, DT)

    def cost(q: np.ndarray) -> float:
        return solver.objective.value(q) + weight * float(np.sum((q - wanted) ** 2))

    assert result.cost == pytest.approx(cost(result.q), rel=1e-9)
    lower, upper = solver.box(Q_START, DT)
    rng = np.random.default_rng(0)
    for _ in range(200):
        other = np.clip(result.q + rng.normal(scale=1e-4, size=6), lower, upper)
        assert cost(other) >= result.cost * (1.0 - 1e-9)
    # Taken out again, it is forgotten.
    solver.program.RemoveCost(binding)
    plain = IkSolver(lio_plant(), TCP).solve(X, 15.0, Q_START, DT)
    np.testing.assert_array_equal(solver.solve(X, 15.0, Q_START, DT).q, plain.q)


def test_a_users_own_variables_and_a_constraint_that_is_not_linear_work(solver: IkSolver) -> None:
    q, program = solver.posture, solver.program
    (slack,) = program.NewContinuousVariables(1, "mine")
    program.AddLinearCost(50.0 * slack)
    program.AddLinearConstraint(slack >= 0.0)
    program.AddConstraint(q[4] ** 2 + q[5] ** 2 - slack <= 2.0)
    before = Q_START[4] ** 2 + Q_START[5] ** 2
    assert before > 2.1
    end = follow(solver, pose_of(solver, Q_START + 0.1), 60)
    assert end[4] ** 2 + end[5] ** 2 == pytest.approx(2.0, abs=1e-3)


def test_what_cannot_be_met_holds_the_arm_and_says_so(solver: IkSolver) -> None:
    solver.program.AddBoundingBoxConstraint(Q_START[2] + 1.0, np.inf, solver.posture[2])
    result = solver.solve(pose_of(solver, Q_START + 0.3), 15.0, Q_START, DT)
    assert result.status == IkStatus.HELD
    np.testing.assert_array_equal(result.q, Q_START)
