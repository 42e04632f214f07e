"""A tick against the whole nonlinear program, written with Drake's own costs and given to its nonlinear solvers.

Nothing of ours is in it: positions by Drake's `PositionCost`, the angle from an AutoDiffXd copy of the plant.
"""

import numpy as np
import pytest
from ik_arm import Q_START, TCP, lio_plant, pose_of
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RotationMatrix, atan2, sqrt
from pydrake.multibody.inverse_kinematics import PositionCost
from pydrake.solvers import IpoptSolver, MathematicalProgram, SnoptSolver, SolverInterface, SolverOptions

from diagrams.ik.solver import IkSolver

DT = 0.01


class NonlinearTick:
    """The objective over all 8 joints, the two of the fingers held."""

    def __init__(self) -> None:
        self.plant = lio_plant()
        self.context = self.plant.CreateDefaultContext()
        self.plant_ad = self.plant.ToAutoDiffXd()
        self.context_ad = self.plant_ad.CreateDefaultContext()

    def angle_squared(self, q: np.ndarray, R_target: RotationMatrix) -> object:
        """θ² with its derivatives: θ = 2 atan2(|v|, |w|) of the error's quaternion."""
        self.plant_ad.SetPositions(self.context_ad, q)
        R = self.plant_ad.GetFrameByName(TCP).CalcPoseInWorld(self.context_ad).rotation().matrix()
        E = R @ R_target.matrix().T
        w = 0.5 * sqrt(1.0 + E[0, 0] + E[1, 1] + E[2, 2])
        x, y, z = (E[2, 1] - E[1, 2]) / (4 * w), (E[0, 2] - E[2, 0]) / (4 * w), (E[1, 0] - E[0, 1]) / (4 * w)
        square = x * x + y * y + z * z
        if square.value() < 1e-20:
            return 4.0 * square
        half = atan2(sqrt(square), w)
        return 4.0 * half * half

    def solve(
        self, nonlinear: SolverInterface, X: np.ndarray, w: float, q_prev: np.ndarray, box: tuple[np.ndarray, ...]
    ) -> tuple[np.ndarray, float]:
        """The best posture of the arm (6,) and its cost."""
        plant, world = self.plant, self.plant.world_frame()
        tool = plant.GetFrameByName(TCP)
        program = MathematicalProgram()
        q = program.NewContinuousVariables(8)
        position = PositionCost(plant, world, X[:3], tool, np.zeros(3), 100.0 * np.eye(3), self.context)
        program.AddCost(position, q)
        R_target = RotationMatrix(Quaternion(X[3:] / np.linalg.norm(X[3:])))
        program.AddCost(lambda q: w * self.angle_squared(q, R_target), vars=q)
        span = (plant.GetPositionUpperLimits() - plant.GetPositionLowerLimits())[:6]
        program.AddQuadraticErrorCost(np.diag(1.0 / span**2), q_prev, q[:6])
        program.AddBoundingBoxConstraint(*box, q[:6])
        program.AddBoundingBoxConstraint(0.0, 0.0, q[6:])
        options = SolverOptions()
        options.SetOption(SnoptSolver.id(), "Major optimality tolerance", 1e-9)
        options.SetOption(IpoptSolver.id(), "tol", 1e-10)
        options.SetOption(IpoptSolver.id(), "bound_relax_factor", 0.0)
        middle = np.concatenate((np.mean(box, axis=0), np.zeros(2)))
        result = nonlinear.Solve(program, middle, options)
        return result.GetSolution(q)[:6], result.get_optimal_cost()


@pytest.fixture(scope="module")
def solver() -> IkSolver:
    return IkSolver(lio_plant(), TCP)


@pytest.fixture(scope="module")
def tick() -> NonlinearTick:
    return NonlinearTick()


@pytest.mark.parametrize(("nonlinear", "ticks"), [(SnoptSolver(), 6), (IpoptSolver(), 1)], ids=["snopt", "ipopt"])
@pytest.mark.parametrize("w", [0.1, 15.0])
@pytest.mark.parametrize("far", [0.004, 0.03, 0.15])
def test_answers_are_those_of_the_nonlinear_program(
    solver: IkSolver, tick: NonlinearTick, nonlinear: SolverInterface, ticks: int, w: float, far: float
) -> None:
    rng = np.random.default_rng(11)
    asked = 0
    for _ in range(ticks):
        q_prev = Q_START + rng.normal(scale=0.3, size=6)
        X = pose_of(solver, q_prev + rng.normal(scale=far, size=6))
        result = solver.solve(X, w, q_prev, DT)
        asked += result.solver_calls
        q, cost = tick.solve(nonlinear, X, w, q_prev, solver.box(q_prev, DT))
        # IPOPT stays a little inside its bounds, and SNOPT may end early: neither may be better.
        assert result.cost <= cost * (1.0 + 1e-6)
        assert cost <= result.cost * (1.0 + 1e-4) + 1e-9
        np.testing.assert_allclose(result.q, q, atol=2e-4)
    assert (asked > 0) == (far > 0.01)


def test_at_a_joints_limit_it_is_the_same(solver: IkSolver, tick: NonlinearTick) -> None:
    q_prev = Q_START.copy()
    q_prev[2] = solver.q_max[2] - 0.003
    X = pose_of(solver, q_prev + np.array([0.0, 0.004, 0.01, 0.0, 0.005, 0.0]))
    result = solver.solve(X, 15.0, q_prev, DT)
    assert result.solver_calls > 0
    assert result.q[2] == solver.q_max[2]
    q, cost = tick.solve(SnoptSolver(), X, 15.0, q_prev, solver.box(q_prev, DT))
    assert result.cost <= cost * (1.0 + 1e-6)
    np.testing.assert_allclose(result.q, q, atol=2e-4)
