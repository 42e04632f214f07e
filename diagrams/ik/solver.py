"""Orientation-weighted inverse kinematics: the exact optimum of one tick, or something safe."""

import math
import time
from typing import NamedTuple

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import Frame
from pydrake.solvers import MathematicalProgram
from pydrake.systems.framework import Diagram
from scipy.linalg.lapack import dpotrs

from canal.errors import InputError
from diagrams.ik.collision_distance import SLACK_PRICE, CollisionDistance, Cuts
from diagrams.ik.kinematics import ArmKinematics
from diagrams.ik.objective import PoseObjective
from diagrams.ik.options import IkOptions, IkStatus
from diagrams.ik.program import StepProgram
from diagrams.ik.target import all_finite, wanted_pose, wanted_weight

POSITION_TOLERANCE = 1e-3
"""A miss above this [m] at rest is reported as out of reach."""
# Gap to the optimum at which a tick ends, relative to the cost; the floor is the cost of standing still exactly.
_RELATIVE_GAP = 3e-8
_COST_FLOOR = 1e-9
_MOST_STEPS = 30
_DAMPING_GROWTH = 4.0
AT_REST = 1e-8
"""Of a step [rad] that is smaller in every joint nothing is done: the posture is the best one already, to 10 nm at the
tool, and the arm stands exactly still instead of creeping along the flat of the objective for ever."""
# A last step below this [rad] is no start: within the gap it could go on for ever.
_SLOW = 1e-4
# A start that costs more than this (3 mm off) has to be better than the last posture, since the gap is wide there.
_COSTLY = 1e-3


class IkResult(NamedTuple):
    """What one tick came to."""

    q: np.ndarray
    """Posture, shape (n,); always finite and within the tick's bounds."""
    status: IkStatus
    cost: float
    """f(q), NaN when held."""
    position_error: float
    """[m], NaN when held."""
    orientation_error: float
    """[rad], NaN when held."""
    iterations: int
    """Quadratic programs."""
    solver_calls: int
    """How many of them were solved by Drake's solver, since an inequality was active."""
    bound_violation: float
    """Largest excess over the tick's bounds [rad]."""
    solve_time: float
    """[s]"""
    clearance: float = math.nan
    """Least distance of a watched pair [m], NaN when none is watched or when held."""


class IkSolver:
    """Gauss-Newton's method inside the box that one tick allows, each step one quadratic program of Drake's.

    The plant is for kinematics only and needs neither actuators nor gravity. Every call starts from its arguments
    alone: there is no state but buffers.

    Attributes:
        kinematics: the chain of joints; q_min, q_max, v_max: the bounds in use, shape (n,).
        clearance: distance to a collision, where it is avoided.
        posture, step: decision variables of `program`: q at the tick's end and q - q_prev, shape (n,).
        options: as given.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        tcp_frame: Frame | str,
        options: IkOptions | None = None,
        base_frame: Frame | str | None = None,
        diagram: Diagram | None = None,
    ) -> None:
        """Build the solver.

        Args:
            plant: any finalized MultibodyPlant; `diagram`, with its SceneGraph, is needed for collision avoidance.
            tcp_frame: the tool's frame T; base_frame: B, in which targets are given, the world when not given.
            options: see `IkOptions`.
            diagram: that holds the plant and its SceneGraph, for `options.collision_avoidance`.

        Raises:
            InputError: an option cannot be used, or the frame does not hang from the base.
        """
        self.options = options = IkOptions() if options is None else options
        tool = plant.GetFrameByName(tcp_frame) if isinstance(tcp_frame, str) else tcp_frame
        base = plant.GetFrameByName(base_frame) if isinstance(base_frame, str) else base_frame
        root_context = None if diagram is None else diagram.CreateDefaultContext()
        context = None if root_context is None else plant.GetMyMutableContextFromRoot(root_context)
        self.kinematics = ArmKinematics(plant, tool, base, context)
        n = self.kinematics.n
        self.q_min = self.kinematics.q_min + options.soft_limit_margin
        self.q_max = self.kinematics.q_max - options.soft_limit_margin
        if not np.all(self.q_min < self.q_max):
            joint = self.kinematics.joint_names[int(np.argmin(self.q_max - self.q_min))]
            raise InputError(
                f"soft_limit_margin {options.soft_limit_margin:g} rad leaves joint '{joint}' no range; make it smaller"
            )
        if len(options.speed_limits) not in (0, n):
            raise InputError(f"speed_limits {options.speed_limits}: give {n} positive values, one a joint")
        self.v_max = np.array(options.speed_limits) if options.speed_limits else self.kinematics.v_max
        if not np.all(np.isfinite(self.v_max)):
            raise InputError("the model gives no joint speed limits; set speed_limits [rad/s] in the IK options")
        self.objective = PoseObjective(self.kinematics, options.position_weight)
        self._identity = np.eye(n)
        self.clearance: CollisionDistance | None = None
        if options.collision_avoidance is not None:
            if diagram is None or root_context is None:
                raise InputError(
                    "collision_avoidance needs the diagram of the plant and its SceneGraph; give `diagram`"
                )
            self.clearance = CollisionDistance(self.kinematics, diagram, root_context, options.collision_avoidance)
        self.quadratic = StepProgram(n, None if self.clearance is None else SLACK_PRICE)
        self.posture, self.step = self.quadratic.posture, self.quadratic.step
        self._q_middle = np.clip(
            np.where(np.isfinite(self.q_min + self.q_max), self.kinematics.q_default, 0.0), self.q_min, self.q_max
        )

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.kinematics.n

    @property
    def program(self) -> MathematicalProgram:
        """The quadratic program of a step, to add costs and constraints of one's own to: see `StepProgram`.

        They belong to functions of `posture`, `step` and variables that are added with them, and hold from the next
        tick on. Where they cannot be met, the arm holds.
        """
        return self.quadratic.program

    def solve(
        self,
        X_desired: np.ndarray,
        w_o: float | np.ndarray,
        q_prev: np.ndarray,
        dt: float,
        v_prev: np.ndarray | None = None,
    ) -> IkResult:
        """The posture that minimises the objective within one tick's bounds.

        Args:
            X_desired: wanted pose of the tool in the base frame: position [m], quaternion (w, x, y, z), shape (7,).
            w_o: weight of orientation; negative counts as 0.
            q_prev: posture one tick ago, shape (n,).
            dt: length of the tick [s].
            v_prev: joint velocity of the last tick, shape (n,): a better start when given.

        Whatever the arguments hold, the result is finite and within the bounds; it never raises on values.
        """
        begin = time.perf_counter()
        q_prev = np.asarray(q_prev, dtype=float)
        held = not all_finite(q_prev)
        if held:
            q_prev = np.where(np.isfinite(q_prev), q_prev, self._q_middle)
        if not (dt > 0.0 and math.isfinite(dt)):
            dt, held = 0.0, True
        if v_prev is not None:
            v_prev = np.asarray(v_prev, dtype=float)
            if not all_finite(v_prev):
                v_prev, held = np.zeros(self.n), True
        lower, upper = self.box(q_prev, dt)
        target = None if held else wanted_pose(X_desired)
        weight = None if held else wanted_weight(w_o)
        if target is None or weight is None:
            return self._hold(q_prev, lower, upper, begin)
        self.objective.set_target(*target, weight, q_prev)
        start = q_prev
        if v_prev is not None and max(map(abs, v_prev.tolist())) * dt > _SLOW:
            start = q_prev + v_prev * dt
        calls = self.quadratic.solver_calls
        q, cost, iterations, clearance = self._minimise(
            np.minimum(np.maximum(start, lower), upper), q_prev, lower, upper
        )
        calls = self.quadratic.solver_calls - calls
        if not math.isfinite(cost):
            return self._hold(q_prev, lower, upper, begin)
        if np.abs(q - q_prev).max() < AT_REST and ((q_prev >= lower) & (q_prev <= upper)).all():
            q = q_prev.copy()
        position, orientation = self.objective.position_error, self.objective.orientation_error
        active = (q <= lower) | (q >= upper)
        near = self.clearance is not None and self.clearance.at_margin(clearance)
        status = IkStatus.AT_BOUND if near or active.any() else IkStatus.CONVERGED
        if position > POSITION_TOLERANCE:
            at_limit = (q <= self.q_min) | (q >= self.q_max)
            if not (active & ~at_limit).any():
                status = IkStatus.OUT_OF_REACH
        violation = max(float(np.maximum(lower - q, q - upper).max()), 0.0)
        spent = time.perf_counter() - begin
        return IkResult(q, status, cost, position, orientation, iterations, calls, violation, spent, clearance)

    def box(self, q_prev: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest posture (n,) that a tick of dt [s] from q_prev (n,) may end in.

        Position limits hold unless the start lies outside them; then the joint comes back as fast as its speed allows.

        Args:
            q_prev: the last posture, [rad]. Shape (n,).
            dt: duration of the tick, [s].
        """
        reach = self.v_max * dt
        below, above = q_prev - reach, q_prev + reach
        return (
            np.minimum(np.maximum(self.q_min, below), above),
            np.maximum(np.minimum(self.q_max, above), below),
        )

    def _minimise(
        self, q: np.ndarray, q_prev: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, float, int, float]:
        """Gauss-Newton's method from q, damped where it does not descend: posture, cost, iterations, least distance.

        The cost is f, the price of missing clearance and the user's own costs; it is infinite if the program has no
        solution. The objective is left evaluated at the posture that is returned.
        """
        objective, quadratic = self.objective, self.quadratic
        quadratic.begin_tick(q_prev, lower, upper)
        cuts = Cuts(self.clearance, q_prev)
        f = objective.value(q)
        if f > _COSTLY:
            at_rest = np.minimum(np.maximum(q_prev, lower), upper)
            q = at_rest if objective.value(at_rest) <= f else q
            f = objective.value(q)
        cost, least = f + cuts.add(q), cuts.least
        if quadratic.extended:
            cost = math.inf  # what a user demands need not hold here
        gradient, hessian = objective.model()
        damping, iteration, here = 0.0, 0, True
        while iteration < _MOST_STEPS:
            iteration += 1
            model = hessian if damping == 0.0 else hessian + damping * self._identity
            step = quadratic.solve(f, gradient, model, q, cuts.rows)
            if step is None:
                if cost == math.inf:
                    break
                damping = max(_DAMPING_GROWTH * damping, float(np.abs(hessian).sum(axis=1).max()))
                continue
            predicted = step.cost + cuts.price(step.slack) + step.extra
            expected, enough = cost - predicted, _RELATIVE_GAP * max(abs(predicted), _COST_FLOOR)
            if expected <= enough:
                break
            f_new = objective.value(step.q)
            cost_new = f_new + cuts.add(step.q) + step.extra
            here = cost_new < cost
            error = cost_new - predicted
            if cost < math.inf:
                # So much damping that the model would have agreed with what was seen along this step.
                damping = max(damping + 2.0 * error / float((step.q - q).dot(step.q - q)), 0.0)
            if not here:
                continue
            q, f, cost, least = step.q, f_new, cost_new, cuts.least
            if step.factor is not None and cost == f:
                if _left(objective.gradient(), step.factor, q <= lower, q >= upper) <= enough:
                    break
            elif error * error < enough * expected < math.inf:
                break  # what the model missed, squared, over what it promised, is what is left
            gradient, hessian = objective.model()
        if not here:
            objective.value(q)
        return q, cost, iteration, least

    def _hold(self, q_prev: np.ndarray, lower: np.ndarray, upper: np.ndarray, begin: float) -> IkResult:
        """The last posture, or the nearest on the way back into the limits."""
        q = np.minimum(np.maximum(q_prev, lower), upper)
        nan = math.nan
        return IkResult(q, IkStatus.HELD, nan, nan, nan, 0, 0, 0.0, time.perf_counter() - begin)


def _left(gradient: np.ndarray, factor: np.ndarray, at_lower: np.ndarray, at_upper: np.ndarray) -> float:
    """What one more step with the last one's factor would gain, ½ gᵀH⁻¹g; infinite if a bound would let go."""
    if (at_lower & (gradient < 0.0) | at_upper & (gradient > 0.0)).any():
        return math.inf
    g = np.where(at_lower | at_upper, 0.0, gradient)
    return 0.5 * float(g.dot(dpotrs(factor, g)[0]))
