"""The contenders: the same tick, one call each. What is not installed is left out, and said.

Each takes pose (7,), weight, q_prev (n,), v_prev (n,) and the tick's box, and returns a posture (n,).
"""

import importlib
import xml.etree.ElementTree as ET
from collections.abc import Callable

import numpy as np
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.inverse_kinematics import InverseKinematics
from pydrake.solvers import NloptSolver, SnoptSolver
from scipy.optimize import minimize

from benchmarks.ik.cases import DT
from diagrams.ik.solver import IkSolver
from diagrams.ik.target import wanted_pose
from diagrams.station.lio_arm import BASE_FRAME, TCP_FRAME, make_arm_plant
from models import LIO_URDF

Contender = Callable[[np.ndarray, float, np.ndarray, np.ndarray, np.ndarray, np.ndarray], np.ndarray]
# What ran on the robot: forward differences with this step.
ROBOT_STEP = 1000.0 * np.finfo(float).eps
# Those that minimise the very objective, to convergence (the others take one linearised step, or 1 - cos θ).
SAME_OBJECTIVE = ("this", "PANOC, differences", "PANOC, gradient", "scipy L-BFGS-B")
# Looser is faster, and worse: at 1e-4 the median gap is 4e-3, at 1e-3 it is 0.9, and still 14 times our time.
_PANOC_TOLERANCE = 1e-5


def contenders(solver: IkSolver) -> dict[str, Contender]:
    """All that can be had, by name; "this" is the project's."""
    found: dict[str, Contender] = {
        "this": lambda X, w, q, v, lower, upper: solver.solve(X, w, q, DT, v).q,
        "scipy L-BFGS-B": _lbfgsb(IkSolver(make_arm_plant(), TCP_FRAME)),
        "Drake IK, SNOPT": _drake(SnoptSolver()),
        "Drake IK, NLopt": _drake(NloptSolver()),
    }
    makers = (
        ("alpaqa", "PANOC, differences", lambda: _panoc(IkSolver(make_arm_plant(), TCP_FRAME), differences=True)),
        ("alpaqa", "PANOC, gradient", lambda: _panoc(IkSolver(make_arm_plant(), TCP_FRAME), differences=False)),
        ("mink", "mink", lambda: _mink(solver)),
        ("pink", "pink", lambda: _pink(solver)),
    )
    for module, name, make in makers:
        try:
            importlib.import_module(module)
        except ImportError:
            print(f"left out: {name} ('{module}' is not installed; pip install -e '.[bench]')")
            continue
        found[name] = make()
    return found


def _set_tick(solver: IkSolver, X: np.ndarray, w: float, q: np.ndarray) -> None:
    target = wanted_pose(X)
    assert target is not None
    solver.objective.set_target(*target, w, q)


def _panoc(solver: IkSolver, *, differences: bool) -> Contender:
    import alpaqa

    objective, n = solver.objective, solver.n

    class Problem(alpaqa.BoxConstrProblem):
        def __init__(self) -> None:
            super().__init__(n, 0)

        def eval_objective(self, x):
            return objective.value(x)

        def eval_objective_gradient(self, x, gradient):
            value = objective.value(x)
            if not differences:
                gradient[:] = objective.gradient()
                return value
            y = np.array(x)
            for i in range(n):
                y[i] = x[i] + ROBOT_STEP
                gradient[i] = (objective.value(y) - value) / ROBOT_STEP
                y[i] = x[i]
            return value

        def eval_objective_and_gradient(self, x, gradient):
            return self.eval_objective_gradient(x, gradient)

        def eval_constraints(self, x, values):
            pass

        def eval_constraints_gradient_product(self, x, y, product):
            product[:] = 0.0

    problem = Problem()
    wrapped = alpaqa.Problem(problem)
    panoc = alpaqa.PANOCSolver({"max_iter": 100}, {"memory": 10})

    def solve(X, w, q, v, lower, upper):
        _set_tick(solver, X, w, q)
        problem.variable_bounds.lower, problem.variable_bounds.upper = lower, upper
        start = np.clip(q, lower, upper)
        x, _ = panoc(wrapped, {"tolerance": _PANOC_TOLERANCE}, start, asynchronous=False)
        return x

    return solve


def _lbfgsb(solver: IkSolver) -> Contender:
    objective = solver.objective

    def both(q):
        value = objective.value(q)
        return value, objective.gradient()

    def solve(X, w, q, v, lower, upper):
        _set_tick(solver, X, w, q)
        bounds = np.column_stack((lower, upper))
        options = {"ftol": 1e-12, "gtol": 1e-6}
        return minimize(both, np.clip(q, lower, upper), jac=True, method="L-BFGS-B", bounds=bounds, options=options).x

    return solve


def _drake(nonlinear_solver) -> Contender:
    plant = make_arm_plant()
    tool, base = plant.GetFrameByName(TCP_FRAME), plant.GetFrameByName(BASE_FRAME)
    context = plant.CreateDefaultContext()
    n = 6
    d = 1.0 / (plant.GetPositionUpperLimits()[:n] - plant.GetPositionLowerLimits()[:n]) ** 2

    def solve(X, w, q, v, lower, upper):
        ik = InverseKinematics(plant, context, with_joint_limits=False)
        program, arm = ik.prog(), ik.q()[:n]
        pose = RigidTransform(RotationMatrix(_quaternion(X)), X[:3])
        ik.AddPositionCost(base, pose.translation(), tool, np.zeros(3), 100.0 * np.eye(3))
        # Its orientation cost is c (1 - cos θ): c = 2 w agrees with w θ² where θ is small.
        ik.AddOrientationCost(base, pose.rotation(), tool, RotationMatrix(), 2.0 * w)
        program.AddQuadraticErrorCost(np.diag(d), q, arm)
        program.AddBoundingBoxConstraint(lower, upper, arm)
        program.AddBoundingBoxConstraint(0.0, 0.0, ik.q()[n:])
        start = np.concatenate((np.clip(q, lower, upper), np.zeros(plant.num_positions() - n)))
        return nonlinear_solver.Solve(program, start, None).GetSolution(arm)

    return solve


def _quaternion(X: np.ndarray):
    from pydrake.common.eigen_geometry import Quaternion

    return Quaternion(X[3:] / np.linalg.norm(X[3:]))


def arm_urdf() -> str:
    """The shipped robot without shells, fingers and drives, for libraries that read URDF."""
    robot = ET.parse(LIO_URDF).getroot()
    for element in list(robot):
        name = element.get("name", "")
        if element.tag not in ("link", "joint") or "finger" in name:
            robot.remove(element)
            continue
        for part in list(element):
            if part.tag in ("visual", "collision"):
                element.remove(part)
    return ET.tostring(robot, encoding="unicode")


def _mink(solver: IkSolver) -> Contender:
    import mink
    import mujoco

    compiler = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco>'
    model = mujoco.MjModel.from_xml_string(arm_urdf().replace("</robot>", compiler + "</robot>"))
    configuration = mink.Configuration(model)
    frame = mink.FrameTask(TCP_FRAME, "body", position_cost=10.0, orientation_cost=1.0)
    posture = mink.PostureTask(model, cost=1.0 / (solver.q_max - solver.q_min))
    names = solver.kinematics.joint_names
    limits = [
        mink.ConfigurationLimit(model, gain=1.0),
        mink.VelocityLimit(model, dict(zip(names, solver.v_max, strict=True))),
    ]

    def solve(X, w, q, v, lower, upper):
        configuration.update(q)
        frame.set_orientation_cost(np.sqrt(w))
        frame.set_target(mink.SE3(wxyz_xyz=np.concatenate((X[3:] / np.linalg.norm(X[3:]), X[:3]))))
        posture.set_target(q)
        velocity = mink.solve_ik(configuration, [frame, posture], DT, "daqp", damping=0.0, limits=limits)
        return q + velocity * DT

    return solve


def _pink(solver: IkSolver) -> Contender:
    import pink
    import pinocchio

    model = pinocchio.buildModelFromXML(arm_urdf())
    data = model.createData()
    frame = pink.FrameTask(TCP_FRAME, position_cost=10.0, orientation_cost=1.0)
    posture = pink.PostureTask(cost=1.0)
    posture.cost = 1.0 / (solver.q_max - solver.q_min)
    limits = [pink.limits.ConfigurationLimit(model, 1.0), pink.limits.VelocityLimit(model)]

    def solve(X, w, q, v, lower, upper):
        configuration = pink.Configuration(model, data, q)
        frame.set_orientation_cost(np.sqrt(w))
        turn = pinocchio.Quaternion(*(X[3:] / np.linalg.norm(X[3:])))
        frame.set_target(pinocchio.SE3(turn, X[:3]))
        posture.set_target(q)
        velocity = pink.solve_ik(configuration, [frame, posture], DT, solver="daqp", damping=0.0, limits=limits)
        return q + velocity * DT

    return solve
