"""The quadratic program of one Newton step: min ½ sᵀHs + gᵀs within lower ≤ s ≤ upper.

Three ways to the same answer, cheapest first: the unconstrained step, when it lies inside; a primal-dual active
set that starts from the joints this step would push out; and Drake's solvers on one `MathematicalProgram` that is built
once, whose answer only names the active set, which is then finished exactly.
"""

import numpy as np
from pydrake.solvers import ClarabelSolver, MathematicalProgram, OsqpSolver, SolverInterface, SolverOptions
from scipy.linalg.lapack import dposv

from canal.errors import InputError

_ACTIVE_SET_CHANGES = 12
_SOLVERS: dict[str, type[SolverInterface]] = {"clarabel": ClarabelSolver, "osqp": OsqpSolver}
# OSQP's default tolerance of 1e-3 does not name the active set reliably; polishing prints.
_OSQP_TOLERANCE = 1e-8


class BoxQuadraticProgram:
    """One reusable program with n variables.

    Attributes:
        program: the Drake `MathematicalProgram`; its cost and bounds are those of the last step that needed a solver.
        solver_calls: how often a Drake solver was asked, for reports.
    """

    def __init__(self, n: int, solvers: list[str]) -> None:
        unknown = [name for name in solvers if name not in _SOLVERS]
        if unknown:
            raise InputError(f"unknown QP solver '{unknown[0]}': use some of {', '.join(_SOLVERS)}")
        self.n = n
        self.program = MathematicalProgram()
        self._s = self.program.NewContinuousVariables(n, "s")
        self._cost = self.program.AddQuadraticCost(np.eye(n), np.zeros(n), self._s, is_convex=True).evaluator()
        self._box = self.program.AddBoundingBoxConstraint(np.zeros(n), np.zeros(n), self._s).evaluator()
        self._solvers = [_SOLVERS[name]() for name in solvers]
        self._options = SolverOptions()
        for key in ("eps_abs", "eps_rel"):
            self._options.SetOption(OsqpSolver.id(), key, _OSQP_TOLERANCE)
        self._masks: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}
        self.solver_calls = 0

    def solve(
        self, H: np.ndarray, g: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """The step and which joints are at a bound, (n,) and boolean (n,); None if H is not positive definite.

        H symmetric (n, n), g (n,), lower ≤ upper (n,). If every method fails, the projected gradient's step.
        """
        _, step, info = dposv(H, -g)
        if info:
            return None
        outside = (step < lower) | (step > upper)
        if not outside.any():
            return step, outside
        found = self._active_set(H, g, lower, upper, step < lower, step > upper)
        if found is not None:
            return found
        for solver in self._solvers:
            self._cost.UpdateCoefficients(H, g, is_convex=True)
            self._box.UpdateLowerBound(lower)
            self._box.UpdateUpperBound(upper)
            self.solver_calls += 1
            result = solver.Solve(self.program, None, self._options)
            if not result.is_success():
                continue
            guess = result.get_x_val()
            near = 1e-6 * (upper - lower) + 1e-12
            found = self._active_set(H, g, lower, upper, guess < lower + near, guess > upper - near)
            if found is not None:
                return found
            guess = np.minimum(np.maximum(guess, lower), upper)
            return guess, (guess == lower) | (guess == upper)
        scale = float(np.abs(H).sum(axis=1).max())  # at least the largest eigenvalue
        step = np.minimum(np.maximum(-g / scale, lower), upper)
        return step, (step == lower) | (step == upper)

    def _active_set(
        self,
        H: np.ndarray,
        g: np.ndarray,
        lower: np.ndarray,
        upper: np.ndarray,
        at_lower: np.ndarray,
        at_upper: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """Exact solution by guessing the active set until the multipliers agree; None if it does not settle."""
        for _ in range(_ACTIVE_SET_CHANGES):
            active = at_lower | at_upper
            masks = self._masks.get(active.tobytes())
            if masks is None:
                free = (~active).astype(float)
                masks = self._masks[active.tobytes()] = (np.outer(free, free), np.diag(1.0 - free))
            fixed = np.where(at_lower, lower, upper)
            fixed[~active] = 0.0
            rhs = -(g + H.dot(fixed))
            _, step, info = dposv(H * masks[0] + masks[1], np.where(active, fixed, rhs))
            if info:
                return None
            step[active] = fixed[active]
            slope = g + H.dot(step)  # at a bound, minus the multiplier
            next_lower = (step < lower) | (at_lower & (slope >= 0.0))
            next_upper = (step > upper) | (at_upper & (slope <= 0.0))
            if not ((next_lower != at_lower) | (next_upper != at_upper)).any():
                return step, active
            at_lower, at_upper = next_lower, next_upper
        return None
