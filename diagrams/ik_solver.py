"""Orientation-weighted inverse kinematics: the exact optimum of one tick, or something safe."""

import math
import time
from typing import NamedTuple

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import Frame
from pydrake.systems.framework import Diagram

from canal.errors import InputError
from diagrams.ik_bounds import StepBounds
from diagrams.ik_clear_step import ClearStep, minimise_clear
from diagrams.ik_clearance import Clearance
from diagrams.ik_kinematics import ArmKinematics
from diagrams.ik_objective import PoseObjective
from diagrams.ik_options import IkOptions, IkStatus
from diagrams.ik_quadratic import BoxQuadraticProgram

# Gap to the optimum at which a tick ends, relative to the cost; the floor is the cost of standing still exactly.
_RELATIVE_GAP = 1e-7
_COST_FLOOR = 1e-9
# A target further off than this [m] pulls in the same direction, and its square stays finite.
_FAR = 1e3
_LEAST_QUATERNION = 1e-6
_AT_MARGIN = 1e-5  # [m], nearer than this beyond the margin counts as at it
_DAMPING_GROWTH = 4.0
# In a box narrower than this [rad] the quadratic model holds throughout, also where it is not convex.
_NARROW = 0.2
_HEAVIEST = 1e9  # an orientation weight above this is as good as infinite


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
    bound_violation: float
    """Largest excess over the tick's bounds [rad]."""
    solve_time: float
    """[s]"""
    clearance: float = math.nan
    """Least distance of a watched pair [m], NaN when none is watched or when held."""


class IkSolver:
    """Newton's method on the exact objective inside the box that one tick allows.

    The plant is for kinematics only and needs neither actuators nor gravity. Every call starts from its arguments
    alone: there is no state but buffers.

    Attributes:
        kinematics: the chain of joints; q_min, q_max, v_max: the bounds in use, shape (n,).
        clearance: distances, when keeping clear.
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
            plant: any finalized MultibodyPlant; `diagram`, with its SceneGraph, is needed to keep clear.
            tcp_frame: the tool's frame T; base_frame: B, in which targets are given, the world when not given.
            options: see `IkOptions`.
            diagram: that holds the plant and its SceneGraph, for `options.keep_clear`.

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
        speeds = _per_joint("speed_limits", options.speed_limits, n)
        self.v_max = self.kinematics.v_max if speeds is None else speeds
        if not np.all(np.isfinite(self.v_max)):
            raise InputError("the model gives no joint speed limits; set speed_limits [rad/s] in the IK options")
        self.a_max = _per_joint("acceleration_limits", options.acceleration_limits, n)
        self.bounds = StepBounds(self.q_min, self.q_max, self.v_max, self.a_max)
        self.objective = PoseObjective(self.kinematics, options.position_weight)
        self.quadratic = BoxQuadraticProgram(n, options.qp_solvers)
        self._identity = np.eye(n)
        self.clearance: Clearance | None = None
        if options.keep_clear is not None:
            if diagram is None or root_context is None:
                raise InputError("keep_clear needs the diagram of the plant and its SceneGraph; give `diagram`")
            self.clearance = Clearance(self.kinematics, diagram, root_context, options.keep_clear)
            self._clear_step = ClearStep(n, options.keep_clear.slack_weight)
        self._axis_weights = tuple(float(w) for w in options.axis_weights)
        if len(self._axis_weights) != 3 or not all(w >= 0.0 and math.isfinite(w) for w in self._axis_weights):
            raise InputError(f"axis_weights {options.axis_weights}: give three finite factors >= 0")
        self._q_middle = np.clip(
            np.where(np.isfinite(self.q_min + self.q_max), self.kinematics.q_default, 0.0), self.q_min, self.q_max
        )

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.kinematics.n

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
            w_o: weight of orientation, one or three (about the tool's axes); negative counts as 0.
            q_prev: posture one tick ago, shape (n,).
            dt: length of the tick [s].
            v_prev: joint velocity of the last tick, shape (n,): needed for the bound on acceleration, and a better
                start when given.

        Whatever the arguments hold, the result is finite and within the bounds; it never raises on values.
        """
        begin = time.perf_counter()
        q_prev = np.asarray(q_prev, dtype=float)
        held = not _all_finite(q_prev)
        if held:
            q_prev = np.where(np.isfinite(q_prev), q_prev, self._q_middle)
        if not (dt > 0.0 and math.isfinite(dt)):
            dt, held = 0.0, True
        if v_prev is not None:
            v_prev = np.asarray(v_prev, dtype=float)
            if not _all_finite(v_prev):
                v_prev, held = np.zeros(self.n), True
        lower, upper = self.bounds.box(q_prev, dt, v_prev)
        target = None if held else _target(X_desired)
        weights = None if held else self._weights(w_o)
        if target is None or weights is None:
            return self._hold(q_prev, lower, upper, begin)
        self.objective.set_target(*target, weights, q_prev)
        start = q_prev if v_prev is None else q_prev + v_prev * dt
        start = np.minimum(np.maximum(start, lower), upper)
        clearance, near = math.nan, False
        if self.clearance is None:
            q, cost, iterations, active = self._minimise(start, lower, upper)
        else:
            q, cost, iterations, active, clearance = minimise_clear(
                self.objective,
                self.clearance,
                self.quadratic,
                self._clear_step,
                start,
                lower,
                upper,
                self.options.max_iterations,
            )
            near = clearance < self.clearance.options.margin + _AT_MARGIN
        if not math.isfinite(cost):
            return self._hold(q_prev, lower, upper, begin)
        position, orientation = self.objective.position_error, self.objective.orientation_error
        status = IkStatus.AT_BOUND if near or active.any() else IkStatus.CONVERGED
        options = self.options
        if position > options.position_tolerance or (
            0.0 < options.orientation_tolerance < orientation and max(weights) > 0.0
        ):
            at_limit = (q <= self.q_min) | (q >= self.q_max)
            if not (active & ~at_limit).any():
                status = IkStatus.OUT_OF_REACH
        violation = float(np.maximum(lower - q, q - upper).max())
        spent = time.perf_counter() - begin
        return IkResult(q, status, cost, position, orientation, iterations, max(violation, 0.0), spent, clearance)

    def _minimise(
        self, q: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, float, int, np.ndarray]:
        """Newton's method from q within the box: posture, cost, iterations, joints at a bound.

        The objective is left evaluated at the posture that is returned.
        """
        objective, quadratic = self.objective, self.quadratic
        f = objective.value(q)
        active = (q <= lower) | (q >= upper)
        damping, narrow = 0.0, bool((upper - lower).max() < _NARROW)
        gradient = None
        iteration = 0
        while iteration < self.options.max_iterations:
            iteration += 1
            if gradient is None:
                gradient, hessian, curvature = objective.derivatives()
            model = hessian if damping == 0.0 else hessian + damping * self._identity
            found = quadratic.solve(model, gradient, lower - q, upper - q)
            if found is None and not narrow:
                model = model - curvature
                found = quadratic.solve(model, gradient, lower - q, upper - q)
            if found is None:
                found = quadratic.descend(model, gradient, lower - q, upper - q)
            step, at_bound = found
            expected = -float(gradient.dot(step) + 0.5 * step.dot(model.dot(step)))
            if expected <= 0.1 * _RELATIVE_GAP * max(f, _COST_FLOOR):
                active = at_bound
                break
            q_new = np.minimum(np.maximum(q + step, lower), upper)
            f_new = objective.value(q_new)
            if not f_new < f:
                objective.value(q)
                # At least what makes the model agree with what was seen along this step.
                seen = 2.0 * (f_new - f + expected) / float(step.dot(step))
                damping = max(_DAMPING_GROWTH * damping, seen)
                continue
            damping = 0.0 if f - f_new > 0.5 * expected else damping / _DAMPING_GROWTH
            q, f, active = q_new, f_new, at_bound
            if quadratic.remaining(objective.gradient()) <= _RELATIVE_GAP * max(f, _COST_FLOOR):
                break
            gradient = None
        return q, f, iteration, active

    def _weights(self, w_o: float | np.ndarray) -> tuple[float, float, float] | None:
        """Weights about the tool's axes, at least 0; None if not finite."""
        if isinstance(w_o, float):
            w = (w_o, w_o, w_o)
        else:
            given = np.asarray(w_o, dtype=float).ravel().tolist()
            w = (given[0],) * 3 if len(given) == 1 else tuple(given)
        if not (len(w) == 3 and math.isfinite(w[0] + w[1] + w[2])):
            return None
        a = self._axis_weights
        x, y, z = (min(max(value, 0.0), _HEAVIEST) for value in w)
        return x * a[0], y * a[1], z * a[2]

    def _hold(self, q_prev: np.ndarray, lower: np.ndarray, upper: np.ndarray, begin: float) -> IkResult:
        """The last posture, or the nearest that the bounds allow (braking, or on the way back into the limits)."""
        q = np.minimum(np.maximum(q_prev, lower), upper)
        nan = math.nan
        return IkResult(q, IkStatus.HELD, nan, nan, nan, 0, 0.0, time.perf_counter() - begin)


def _all_finite(values: np.ndarray) -> bool:
    """Whether all entries are finite and small enough for their arithmetic to stay so."""
    return all(-1e9 < value < 1e9 for value in values.tolist())


def _target(X: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Position (3,) and rotation (3, 3) of a pose vector (7,); None if it has no usable value."""
    values = np.asarray(X, dtype=float).ravel().tolist()
    if len(values) != 7 or not all(map(math.isfinite, values)):
        return None
    x, y, z, qw, qx, qy, qz = values
    length = math.hypot(qw, qx, qy, qz)
    if not _LEAST_QUATERNION < length < 1.0 / _LEAST_QUATERNION:
        return None
    qw, qx, qy, qz = qw / length, qx / length, qy / length, qz / length
    p = np.array((x, y, z))
    distance = math.hypot(x, y, z)
    if distance > _FAR:
        p = p / distance * _FAR
    xx, yy, zz = 2.0 * qx * qx, 2.0 * qy * qy, 2.0 * qz * qz
    xy, xz, yz = 2.0 * qx * qy, 2.0 * qx * qz, 2.0 * qy * qz
    wx, wy, wz = 2.0 * qw * qx, 2.0 * qw * qy, 2.0 * qw * qz
    R = np.array(
        ((1.0 - yy - zz, xy - wz, xz + wy), (xy + wz, 1.0 - xx - zz, yz - wx), (xz - wy, yz + wx, 1.0 - xx - yy))
    )
    return p, R


def _per_joint(name: str, given: list[float], n: int) -> np.ndarray | None:
    """One positive value a joint; None when none is given."""
    if not given:
        return None
    values = np.asarray(given, dtype=float)
    if values.shape != (n,) or not np.all(values > 0.0):
        raise InputError(f"{name} {given}: give {n} positive values, one a joint")
    return values
