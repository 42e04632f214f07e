"""Keeping clear: a path through an obstacle is followed at the margin's distance, and a start inside finds out."""

import numpy as np
import pytest
from ik_arm import TCP, lio_plant, pose_of
from pydrake.geometry import Sphere

from benchmarks.ik.collision_avoidance import MARGIN, Q_FRONT, arm_and, deep_path, least_distance, solver_beside_wall
from canal.errors import InputError
from diagrams.ik.options import CollisionAvoidanceOptions, IkOptions, IkStatus
from diagrams.ik.solver import IkSolver
from diagrams.scenario import load_scenario
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE

DT = 0.01


@pytest.fixture(scope="module")
def solver() -> IkSolver:
    return solver_beside_wall()


def test_a_path_40_mm_into_an_obstacle_is_followed_at_20_mm(solver: IkSolver) -> None:
    blind = IkSolver(lio_plant(), TCP)
    path = deep_path()
    q_clear = q_blind = Q_FRONT
    v = np.zeros(6)
    depth, nearest, at_margin = np.inf, np.inf, 0
    for X in path:
        q_blind = blind.solve(X, 15.0, q_blind, DT).q
        depth = min(depth, least_distance(solver, q_blind))
        result = solver.solve(X, 15.0, q_clear, DT, v)
        assert np.all(np.abs(result.q - q_clear) <= solver.v_max * DT + 1e-12)
        q_clear, v = result.q, (result.q - q_clear) / DT
        distance = least_distance(solver, q_clear)
        assert result.clearance == pytest.approx(min(distance, result.clearance), abs=1e-9)
        nearest = min(nearest, distance)
        at_margin += distance < MARGIN + 1e-4
    assert depth < -0.04
    assert nearest >= MARGIN
    assert at_margin > 100
    np.testing.assert_allclose(pose_of(solver, q_clear)[:3], path[-1][:3], atol=1e-3)


def test_beside_the_margin_the_answer_is_the_unconstrained_one(solver: IkSolver) -> None:
    X = pose_of(solver, Q_FRONT + 0.004)
    free = IkSolver(lio_plant(), TCP).solve(X, 15.0, Q_FRONT, DT)
    result = solver.solve(X, 15.0, Q_FRONT, DT)
    np.testing.assert_allclose(result.q, free.q, atol=1e-6)
    assert result.status == IkStatus.CONVERGED


def test_at_the_margin_the_status_says_so(solver: IkSolver) -> None:
    q = Q_FRONT
    for _ in range(200):
        result = solver.solve(deep_path()[200], 15.0, q, DT)
        q = result.q
    assert result.status in (IkStatus.AT_BOUND, IkStatus.OUT_OF_REACH)
    assert result.clearance >= MARGIN


def test_a_start_inside_an_obstacle_finds_the_way_out() -> None:
    solver = solver_beside_wall()
    blind = IkSolver(lio_plant(), TCP)
    q = Q_FRONT
    for X in deep_path()[:200]:
        q = blind.solve(X, 15.0, q, DT).q
    inside = least_distance(solver, q)
    assert inside < -0.04
    for _ in range(100):
        result = solver.solve(X, 15.0, q, DT)
        assert np.all(np.abs(result.q - q) <= solver.v_max * DT + 1e-12)
        q = result.q
    assert least_distance(solver, q) >= MARGIN


def test_slopes_of_distances_match_finite_differences(solver: IkSolver) -> None:
    clearance, arm = solver.clearance, solver.kinematics
    assert clearance is not None
    q = Q_FRONT + np.array([0.1, 0.1, 0.0, 0.1, 0.1, 0.2])
    arm.set(q)
    near = clearance.near(1.0)
    jacobian = clearance.jacobian(near)
    assert len(near.distances) > 0
    for i in range(6):
        ends = []
        for sign in (1.0, -1.0):
            arm.set(q + sign * 1e-5 * np.eye(6)[i])
            ends.append(clearance.near(1.0).distances)
        # Where faces are parallel the closest points jump, and differences see it.
        off = np.abs(jacobian[:, i] - (ends[0] - ends[1]) / 2e-5)
        assert np.median(off) < 1e-6
        assert off.max() < 1e-3


def test_pairs_that_never_part_are_left_out(solver: IkSolver) -> None:
    plant, diagram = arm_and(Sphere(0.1), [0.0, 1.5, 0.5])
    everything = IkSolver(
        plant, TCP, IkOptions(collision_avoidance=CollisionAvoidanceOptions(margin=MARGIN)), diagram=diagram
    )
    assert everything.clearance is not None
    assert solver.clearance is not None
    assert everything.clearance.pairs > solver.clearance.pairs
    # At rest in the start posture nothing of the arm is watched that touches its neighbour.
    assert least_distance(everything, Q_FRONT) > 0.0


def test_bad_options_are_refused() -> None:
    plant, diagram = arm_and(Sphere(0.1), [0.0, 1.5, 0.5])
    for options, message in ((CollisionAvoidanceOptions(solid_bodies=["no_such_wall"]), "there are"),):
        with pytest.raises(InputError, match=message):
            IkSolver(plant, TCP, IkOptions(collision_avoidance=options), diagram=diagram)
    with pytest.raises(InputError, match="give `diagram`"):
        IkSolver(lio_plant(), TCP, IkOptions(collision_avoidance=CollisionAvoidanceOptions()))


def test_a_scenario_can_ask_the_arm_to_avoid_its_fixtures() -> None:
    plain, scenario = load_scenario("laundry"), load_scenario("laundry-guarded")
    assert make_lio_solver(plain, plain.ik).clearance is None
    solver = make_lio_solver(scenario, scenario.ik)
    assert solver.clearance is not None
    front = pose_of(solver, START_POSTURE)
    q, v = START_POSTURE, np.zeros(6)
    # Straight at the machine's front, beside the door.
    for k in range(300):
        X = front.copy()
        X[1] += 0.9 * k / 300
        result = solver.solve(X, 1.0, q, DT, v)
        q, v = result.q, (result.q - q) / DT
        assert result.status != IkStatus.HELD
        assert result.clearance >= 0.01
