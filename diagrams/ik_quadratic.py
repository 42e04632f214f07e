"""The quadratic program of one Newton step: min ½ sᵀHs + gᵀs within lower ≤ s ≤ upper.

Ways to the same answer, cheapest first: the unconstrained step, when it lies inside; a primal-dual active set that
starts from the joints this step would push out; Drake's solvers on one `MathematicalProgram` that is built once, whose
answer only names the active set, which is then finished exactly; and a descent that adds and drops bounds one at a
time. The last always ends, and also takes an H that is not positive definite, where it finds a local minimum.
"""

import numpy as np
from pydrake.solvers import ClarabelSolver, MathematicalProgram, OsqpSolver, SolverInterface, SolverOptions
from scipy.linalg.lapack import dposv, dpotrf, dpotrs

from canal.errors import InputError

_ACTIVE_SET_CHANGES = 12
_DESCENT_STEPS = 60
_STATIONARY = 1e-13  # [rad], a step that is only rounding
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
        self._options.SetOption(OsqpSolver.id(), "polishing", 0)
        self._masks: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}
        self.solver_calls = 0
        self._factor = np.eye(n)
        self._at_lower = self._at_upper = np.zeros(n, dtype=bool)
        self._constrained = False

    def solve(
        self, H: np.ndarray, g: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """The step and which joints are at a bound, (n,) and boolean (n,); None if H is not positive definite.

        H symmetric (n, n), g (n,), lower ≤ 0 ≤ upper (n,).
        """
        factor, step, info = dposv(H, -g)
        if info:
            return None
        below, above = step < lower, step > upper
        if not (below | above).any():
            self._factor, self._constrained = factor, False
            return step, below
        found = self._active_set(H, g, lower, upper, below, above)
        if found is None:
            found = self._by_solver(H, g, lower, upper)
        return self.descend(H, g, lower, upper) if found is None else found

    def _by_solver(
        self, H: np.ndarray, g: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """As `solve`, H positive definite, the active set named by Drake's solvers in turn."""
        self._cost.UpdateCoefficients(H, g, is_convex=True)
        self._box.UpdateLowerBound(lower)
        self._box.UpdateUpperBound(upper)
        near = 1e-6 * (upper - lower) + 1e-12
        for solver in self._solvers:
            self.solver_calls += 1
            result = solver.Solve(self.program, None, self._options)
            guess = result.get_x_val()
            if result.is_success():
                found = self._active_set(H, g, lower, upper, guess < lower + near, guess > upper - near)
                if found is not None:
                    return found
        return None

    def descend(
        self, H: np.ndarray, g: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """As `solve` for any symmetric H: a local minimum, by a primal active set with negative curvature."""
        # Where a tick's bounds are tight the answer is often the corner that the gradient points to.
        corner = np.where(g > 0.0, lower, upper)
        if g.dot(corner) + 0.5 * corner.dot(H.dot(corner)) < 0.0:
            step, at_lower, at_upper = corner, g > 0.0, g <= 0.0
        else:
            step, at_lower, at_upper = np.zeros(self.n), lower >= 0.0, upper <= 0.0
        for _ in range(_DESCENT_STEPS):
            slope = g + H.dot(step)
            index = np.flatnonzero(~(at_lower | at_upper))
            block = H[np.ix_(index, index)]
            part, info = np.zeros(0), 0
            if len(index):
                _, part, info = dposv(block, -slope[index])
                if info:
                    part = np.linalg.eigh(block)[1][:, 0]  # down the most negative curvature, to a bound
                    part = part if part.dot(slope[index]) <= 0.0 else -part
            if not info and (not len(index) or np.abs(part).max() < _STATIONARY):
                # The best of this face: let go of the bound that pulls back most, one, so that it moves inwards.
                pull = np.where(at_lower, -slope, np.where(at_upper, slope, 0.0))
                joint = int(np.argmax(pull))
                if pull[joint] <= 0.0:
                    break
                at_lower[joint] = at_upper[joint] = False
                continue
            gap = np.where(part > 0.0, upper[index] - step[index], lower[index] - step[index])
            with np.errstate(divide="ignore", invalid="ignore"):
                room = np.where(part != 0.0, gap / part, np.inf)
            first = int(np.argmin(room))
            if not info and room[first] >= 1.0:
                step[index] += part
                continue
            step[index] += room[first] * part
            joint = int(index[first])
            at_upper[joint], at_lower[joint] = part[first] > 0.0, part[first] < 0.0
            step[joint] = upper[joint] if part[first] > 0.0 else lower[joint]
        return self._finished(H, g, lower, upper, step, at_lower, at_upper)

    def _finished(
        self,
        H: np.ndarray,
        g: np.ndarray,
        lower: np.ndarray,
        upper: np.ndarray,
        step: np.ndarray,
        at_lower: np.ndarray,
        at_upper: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:
        """The end of a descent, with the factors of what was left free when these exist."""
        active = at_lower | at_upper
        free, fixed = self._split(active)
        factor, info = dpotrf(H * free + fixed)
        self._factor = np.full((self.n, self.n), np.nan) if info else factor
        self._at_lower, self._at_upper, self._constrained = at_lower, at_upper, True
        return np.minimum(np.maximum(step, lower), upper), active

    def _split(self, active: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Matrices that keep the free joints' block of H, and put ones on the diagonal of the others."""
        key = active.tobytes()
        if key not in self._masks:
            free = (~active).astype(float)
            self._masks[key] = (np.outer(free, free), np.diag(1.0 - free))
        return self._masks[key]

    @property
    def factor(self) -> np.ndarray:
        """Cholesky factor of the last H (n, n), after a `solve` that met no bound."""
        return self._factor

    def remaining(self, g: np.ndarray) -> float:
        """What one more step with the last solution's factors would gain where the gradient is g (n,): ½ gᵀH⁻¹g.

        Infinite when a bound that was active would now let go.
        """
        if self._constrained:
            if ((g < 0.0) & self._at_lower).any() or ((g > 0.0) & self._at_upper).any():
                return np.inf
            g = np.where(self._at_lower | self._at_upper, 0.0, g)
        gain = 0.5 * float(g.dot(dpotrs(self._factor, g)[0]))
        return gain if gain >= 0.0 else np.inf  # not a number where the last model had no minimum

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
            free, ones = self._split(active)
            fixed = np.where(at_lower, lower, upper)
            fixed[~active] = 0.0
            rhs = -(g + H.dot(fixed))
            factor, step, info = dposv(H * free + ones, np.where(active, fixed, rhs))
            if info:
                return None
            step[active] = fixed[active]
            slope = g + H.dot(step)  # at a bound, minus the multiplier
            next_lower = (step < lower) | (at_lower & (slope >= 0.0))
            next_upper = (step > upper) | (at_upper & (slope <= 0.0))
            if not ((next_lower != at_lower) | (next_upper != at_upper)).any():
                self._factor, self._constrained = factor, True
                self._at_lower, self._at_upper = at_lower, at_upper
                return step, active
            at_lower, at_upper = next_lower, next_upper
        return None
