"""Minimising the objective of a tick while every watched pair keeps its margin.

Each step solves   min ½ sᵀHs + gᵀs + ρ σ   within the tick's box, d + A s + σ ≥ margin and σ ≥ 0, where d are signed
distances and A their slopes: sequential quadratic programming with an exact penalty. The slack σ [m] gives a start
inside an obstacle a way out; ρ is large enough that it is zero wherever the margin can be kept.
"""

import numpy as np
from pydrake.solvers import ClarabelSolver, MathematicalProgram
from scipy.linalg.lapack import dposv, dpotrs

from diagrams.ik_clearance import Clearance
from diagrams.ik_objective import PoseObjective
from diagrams.ik_quadratic import BoxQuadraticProgram

# Kept beyond the margin [m], so that what the linearisation leaves over stays on the safe side.
_PAD = 2e-6
_SMALL_STEP = 3e-4  # [rad]; the error that is left is of the order of its square
_GROWTH = 4.0
_CHANGES = 12
_FEASIBLE = 1e-10  # [m], [rad]
# Rows are formed for pairs that are within this of the margin [m]; the step is checked against all.
_NEAR = 0.01
_CARRIED = 3  # linearisations of earlier steps that stay: a flat pair's nearest corner jumps to and fro


class ClearStep:
    """The quadratic program with rows, as one reused Drake `MathematicalProgram`, behind a shortcut.

    Most steps have a row or two active and no bound: then the step is the unconstrained one bent onto those rows, and
    the multipliers prove it. The program is asked only for the rest.
    """

    def __init__(self, n: int, slack_weight: float) -> None:
        self.n, self.slack_weight = n, slack_weight
        self._identity = np.eye(n)
        self.program = MathematicalProgram()
        self._x = self.program.NewContinuousVariables(n + 1, "s")
        self._cost = self.program.AddQuadraticCost(np.eye(n), np.zeros(n), self._x[:n], is_convex=True).evaluator()
        self.program.AddLinearCost(np.array([slack_weight]), 0.0, self._x[n:])
        self._box = self.program.AddBoundingBoxConstraint(np.zeros(n), np.zeros(n), self._x[:n]).evaluator()
        self.program.AddBoundingBoxConstraint(0.0, np.inf, self._x[n])
        self._rows = self.program.AddLinearConstraint(
            np.ones((1, n + 1)), np.array([-np.inf]), np.array([np.inf]), self._x
        ).evaluator()
        self._solver = ClarabelSolver()
        self.solver_calls = 0

    def direct(
        self, H: np.ndarray, g: np.ndarray, A: np.ndarray, missing: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> np.ndarray | None:
        """The step by adding the worst violated constraint and dropping those that pull, one at a time.

        None if H is not positive definite, if this does not settle, or if the slack is needed. What is returned
        satisfies the optimality conditions.
        """
        factor, free, info = dposv(H, -g)
        if info:
            return None
        if not ((A.dot(free) < missing).any() or (free < lower).any() or (free > upper).any()):
            return free
        C = np.vstack((A, self._identity, -self._identity))
        least = np.concatenate((missing, lower, -upper))
        active: list[int] = []
        k, step = len(A), free
        for _ in range(_CHANGES):
            room = C.dot(step) - least
            room[active] = 0.0
            # Rows before bounds: bent onto the rows, the step is mostly short enough for the bounds.
            worst = int(np.argmin(room[:k]))
            if room[worst] >= -_FEASIBLE:
                worst = k + int(np.argmin(room[k:]))
                if room[worst] >= -_FEASIBLE:
                    return step
            active.append(worst)
            while active:
                rows = C[active]
                spread = dpotrs(factor, rows.T)[0]
                _, multipliers, info = dposv(rows.dot(spread), least[active] - rows.dot(free))
                if info:
                    return None
                if multipliers.min() >= 0.0:
                    break
                active.pop(int(np.argmin(multipliers)))
            if sum(m for m, row in zip(multipliers, active, strict=True) if row < k) > self.slack_weight:
                return None
            step = free + spread.dot(multipliers)
        return None

    def solve(
        self, H: np.ndarray, g: np.ndarray, A: np.ndarray, missing: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> np.ndarray | None:
        """The step by Drake's Clarabel, (n,); None if it fails. H positive definite."""
        self.solver_calls += 1
        self._cost.UpdateCoefficients(H, g, is_convex=True)
        self._box.UpdateLowerBound(lower)
        self._box.UpdateUpperBound(upper)
        rows = np.column_stack((A, np.ones(len(A))))
        self._rows.UpdateCoefficients(rows, missing, np.full(len(A), np.inf))
        result = self._solver.Solve(self.program, None, None)
        if not result.is_success():
            return None
        return np.minimum(np.maximum(result.get_x_val()[: self.n], lower), upper)


def minimise_clear(
    objective: PoseObjective,
    clearance: Clearance,
    box: BoxQuadraticProgram,
    rows: ClearStep,
    q: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    max_iterations: int,
) -> tuple[np.ndarray, float, int, np.ndarray, float]:
    """Posture, cost, iterations, joints at a bound, least distance [m]; the objective is left evaluated there."""
    price, margin = rows.slack_weight, clearance.options.margin + _PAD
    widest = clearance.options.influence - clearance.options.margin
    near = min(_NEAR, widest)
    identity = np.eye(len(q))
    f = objective.value(q)
    pairs = clearance.near(near)
    merit = f + price * _lack(pairs.distances, margin)
    cuts: list[tuple[np.ndarray, np.ndarray]] = []
    damping, iteration = 0.0, 0
    gradient = None
    while iteration < max_iterations:
        iteration += 1
        if gradient is None:
            gradient, hessian, curvature = objective.derivatives()
            cuts.append((clearance.slopes(pairs), margin - pairs.distances))
        step = _step(box, rows, hessian + damping * identity, curvature, gradient, cuts, lower - q, upper - q)
        if step is None:
            damping = max(_GROWTH * damping, float(np.abs(hessian).sum(axis=1).max()))
            continue
        q_new = np.minimum(np.maximum(q + step, lower), upper)
        f_new = objective.value(q_new)
        tried = clearance.near(near)
        lack = _lack(tried.distances, margin)
        merit_new = f_new + price * lack
        size = float(np.abs(step).max())
        done = lack < 0.5 * _PAD and size < _SMALL_STEP
        if merit_new < merit or done:
            cuts = [(A, missing - A.dot(q_new - q)) for A, missing in cuts[-_CARRIED:]]
            q, f, merit, pairs = q_new, f_new, merit_new, tried
            gradient, damping = None, 0.0 if damping < 1e-3 else damping / _GROWTH
            if done:
                break
            continue
        # What was met there is a cut too, seen from here.
        A = clearance.slopes(tried)
        cuts = [*cuts[-_CARRIED:], (A, margin - tried.distances + A.dot(q_new - q))]
        objective.value(q)
        if size < 1e-9:
            break
        damping = max(_GROWTH * damping, 1e-2 * float(np.abs(hessian).sum(axis=1).max()))
    least = float(pairs.distances.min(initial=clearance.options.margin + near))
    return q, f, iteration, (q <= lower) | (q >= upper), least


def _step(
    box: BoxQuadraticProgram,
    rows: ClearStep,
    H: np.ndarray,
    curvature: np.ndarray,
    g: np.ndarray,
    cuts: list[tuple[np.ndarray, np.ndarray]],
    lower: np.ndarray,
    upper: np.ndarray,
) -> np.ndarray | None:
    """One quadratic step within the box and the cuts, with the convex part of H where H is not; None if it fails."""
    A = np.vstack([cut for cut, _ in cuts])
    missing = np.concatenate([lack for _, lack in cuts])
    for model in (H, H - curvature):
        if not len(A):
            found = box.solve(model, g, lower, upper)
            if found is not None:
                return found[0]
            continue
        step = rows.direct(model, g, A, missing, lower, upper)
        if step is not None:
            return step
    return rows.solve(H - curvature, g, A, missing, lower, upper) if len(A) else None


def _lack(distances: np.ndarray, margin: float) -> float:
    """How much the nearest pair lacks of the margin [m]."""
    return max(margin - float(distances.min()), 0.0) if len(distances) else 0.0
