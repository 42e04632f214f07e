"""The quadratic program of one step, as one Drake `MathematicalProgram` that is built once and is open to its user.

    minimise    f + ∇fᵀd + ½ dᵀHd + ρ σ         d = s - s_k, the step from where f, ∇f and H were taken
    subject to  q - s = q_prev,  lower ≤ q ≤ upper,  A s + σ ≥ a,  σ ≥ 0

over the tick's posture q, its step s = q - q_prev and, when keeping clear, the slack σ [m] of the distances' rows. It
is solved in closed form, d = -H⁻¹∇f, where that meets every inequality, and by Clarabel where one is active:
`benchmarks/ik/solvers.py` compares it with Drake's others.
"""

from typing import NamedTuple

import numpy as np
from pydrake.solvers import Binding, ChooseBestSolver, ClarabelSolver, MakeSolver, MathematicalProgram, SolverOptions
from scipy.linalg.lapack import dposv

# Clarabel's default of 1e-8 is absolute, and more than the whole cost of an ordinary tick. Feasibility at 1e-11 was
# more than it can do on one program in fifty.
_TOLERANCES = {"tol_gap_abs": 1e-12, "tol_gap_rel": 1e-12, "tol_feas": 1e-9}
# An interior point stops this short of an active bound at most [rad]; then it is put onto it.
_AT_BOUND = 1e-7


class Step(NamedTuple):
    """An answer of the program."""

    q: np.ndarray
    """Posture, shape (n,), within its bounds."""
    cost: float
    """f + ∇fᵀd + ½ dᵀHd there."""
    slack: float
    """σ [m]: how much the worst row lacks."""
    extra: float
    """The user's own costs there."""
    factor: np.ndarray | None
    """Upper Cholesky factor of H where the answer is exact: of the rows and columns of the joints at no bound, else of
    ones."""


class StepProgram:
    """The program, its variables, and how it is solved.

    Attributes:
        posture: decision variables q at the tick's end [rad or m], shape (n,).
        step: decision variables s = q - q_prev, the tick's length times the joint velocity, shape (n,).
    """

    def __init__(self, n: int, slack_price: float | None = None) -> None:
        """`slack_price` ρ [cost] / [m] makes room for rows A s + σ ≥ a; without it there are none."""
        self._program = program = MathematicalProgram()
        self.posture = program.NewContinuousVariables(n, "q")
        self.step = program.NewContinuousVariables(n, "s")
        both = np.concatenate((self.posture, self.step))
        self._difference = np.hstack((np.eye(n), -np.eye(n)))
        self._cost = program.AddQuadraticCost(np.eye(n), np.zeros(n), self.step, is_convex=True).evaluator()
        self._anchor = program.AddLinearEqualityConstraint(self._difference, np.zeros(n), both).evaluator()
        self._box = program.AddBoundingBoxConstraint(np.zeros(n), np.zeros(n), self.posture).evaluator()
        if slack_price is not None:
            slack = program.NewContinuousVariables(1, "slack")
            program.AddLinearCost([slack_price], 0.0, slack)
            program.AddBoundingBoxConstraint(0.0, np.inf, slack)
            self._rows = program.AddLinearConstraint(
                np.ones((1, n + 1)), [-np.inf], [np.inf], np.concatenate((self.step, slack))
            ).evaluator()
        self._own = [*program.GetAllCosts(), *program.GetAllConstraints()]
        self._extra_costs: list[Binding] = []
        self._opened = self.extended = False
        self._clarabel = self._solver = ClarabelSolver()
        self._options = SolverOptions()
        for name, value in _TOLERANCES.items():
            self._options.SetOption(ClarabelSolver.id(), name, value)
        self.solver_calls = 0

    @property
    def program(self) -> MathematicalProgram:
        """The program, to add costs and constraints on `posture`, `step` and variables of one's own to.

        From the next tick on they are part of it. What Clarabel does not take goes to the solver that Drake
        finds best.
        """
        self._opened = True
        return self._program

    def begin_tick(self, q_prev: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> None:
        """Set the last posture, and the tick's least and largest posture, each (n,); look at what a user has added.

        Args:
            q_prev: the last posture, [rad]. Shape (n,).
            lower: least posture of the tick. Shape (n,).
            upper: largest one. Shape (n,).
        """
        self._q_prev, self._lower, self._upper = q_prev, lower, upper
        if not self._opened:
            return
        costs, constraints = self._program.GetAllCosts(), self._program.GetAllConstraints()
        self.extended = len(costs) + len(constraints) > len(self._own)
        self._extra_costs = [cost for cost in costs if cost not in self._own]
        if self._clarabel.AreProgramAttributesSatisfied(self._program):
            self._solver = self._clarabel
        else:
            self._solver = MakeSolver(ChooseBestSolver(self._program))

    def solve(
        self, f: float, gradient: np.ndarray, H: np.ndarray, q: np.ndarray, rows: list[tuple[np.ndarray, np.ndarray]]
    ) -> Step | None:
        """The best step; None if there is none, or if the solver fails.

        Args:
            f: the model's value, [cost].
            gradient: its gradient. Shape (n,).
            H: its Hessian, positive definite. Shape (n, n).
            q: the posture where it was taken, shape (n,), within the bounds.
            rows: pairs of A (k, n) and a (k,), in any number.
        """
        factor, d, info = dposv(H, -gradient)
        best = q + d
        if (
            info == 0
            and not self.extended
            and not ((best < self._lower) | (best > self._upper)).any()
            and all((A.dot(best - self._q_prev) >= a).all() for A, a in rows)
        ):
            return Step(best, f + 0.5 * float(gradient.dot(d)), 0.0, 0.0, factor)
        return self._ask(f, gradient, H, q, rows)

    def _ask(
        self, f: float, gradient: np.ndarray, H: np.ndarray, q: np.ndarray, rows: list[tuple[np.ndarray, np.ndarray]]
    ) -> Step | None:
        """As `solve`, by the solver."""
        self.solver_calls += 1
        self._cost.UpdateCoefficients(H, gradient - H.dot(q - self._q_prev), is_convex=True)
        self._anchor.UpdateCoefficients(self._difference, self._q_prev)
        self._box.set_bounds(self._lower, self._upper)
        if rows:
            A, a = np.vstack([A for A, _ in rows]), np.concatenate([a for _, a in rows])
            self._rows.UpdateCoefficients(np.column_stack((A, np.ones(len(a)))), a, np.full(len(a), np.inf))
        guess = None
        if self.extended:  # by what may need one
            guess = np.zeros(self._program.num_vars())
            guess[: 2 * len(q)] = np.concatenate((q, q - self._q_prev))
        result = self._solver.Solve(self._program, guess, self._options)
        if not result.is_success():
            return None
        best = self._q_prev + result.GetSolution(self.step)
        at_lower, at_upper = best < self._lower + _AT_BOUND, best > self._upper - _AT_BOUND
        best = np.where(at_lower, self._lower, np.where(at_upper, self._upper, best))
        free, factor = ~(at_lower | at_upper), None
        if not rows and not self.extended:
            factor = self._finish(gradient, H, q, best, free)
        d = best - q
        cost = f + float(gradient.dot(d) + 0.5 * d.dot(H.dot(d)))
        slack = max((float((a - A.dot(best - self._q_prev)).max(initial=0.0)) for A, a in rows), default=0.0)
        extra = 0.0
        if self._extra_costs:
            x = result.get_x_val()
            extra = sum(float(self._program.EvalBinding(cost, x)[0]) for cost in self._extra_costs)
        return Step(best, cost, slack, extra, factor)

    def _finish(
        self, gradient: np.ndarray, H: np.ndarray, q: np.ndarray, best: np.ndarray, free: np.ndarray
    ) -> np.ndarray | None:
        """Solve for the joints at no bound exactly, in place, and return the factor, see `Step`.

        Nothing is done, and None returned, if that leaves the bounds.
        """
        fixed, keep = np.where(free, 0.0, best - q), free.astype(float)
        wanted = np.where(free, -gradient - H.dot(fixed), 0.0)
        factor, d, info = dposv(H * np.outer(keep, keep) + np.diag(1.0 - keep), wanted)
        found = q + d
        if info or not ((found >= self._lower) & (found <= self._upper))[free].all():
            return None
        best[free] = found[free]
        return factor
