"""Drake's solvers on the programs of the inverse kinematics: `python -m benchmarks.ik.solvers`.

The programs are those of an arm that lags behind the demonstrations because its joints are slow, so that bounds are
active. Each solver gets each program, in random order; what it names as active is finished in closed form, as the
inverse kinematics does. Times are the thread's, so that a busy machine counts less; the gap is to the exact optimum, by
scipy's active-set `bvls`, relative to the tick's cost.
"""

import argparse
import logging
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pydrake.solvers import (
    ClarabelSolver,
    ClpSolver,
    IpoptSolver,
    NloptSolver,
    OsqpSolver,
    ScsSolver,
    SnoptSolver,
    SolverInterface,
    SolverOptions,
)
from scipy.optimize import lsq_linear

from benchmarks.ik.cases import DT, demonstration_cases
from benchmarks.table import Row, print_table, write_csv
from diagrams.ik.options import IkOptions
from diagrams.ik.program import StepProgram
from diagrams.ik.solver import IkSolver
from diagrams.ik.target import wanted_pose
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant

_SLOW = 0.1  # [rad/s]
_COST_FLOOR = 1e-9


class Program(NamedTuple):
    """One step's model at q, and the tick's bounds."""

    f: float
    gradient: np.ndarray
    H: np.ndarray
    q: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def programs(every: int) -> Iterator[Program]:
    """Every n-th tick's first program in which a bound is active."""
    ik = IkSolver(make_arm_plant(), TCP_FRAME, IkOptions(speed_limits=[_SLOW] * 6))
    for case in demonstration_cases(IkSolver(make_arm_plant(), TCP_FRAME)):
        q, v = case.q_start, np.zeros(ik.n)
        for tick, X in enumerate(case.poses[::4]):
            if tick % every == 0:
                target = wanted_pose(X)
                assert target is not None
                ik.objective.set_target(*target, case.weight, q)
                f = ik.objective.value(q)
                gradient, H = ik.objective.model()
                lower, upper = ik.box(q, DT)
                free = q - np.linalg.solve(H, gradient)
                if ((free < lower) | (free > upper)).any():
                    yield Program(f, gradient, H, q, lower, upper)
            result = ik.solve(X, case.weight, q, DT, v)
            q, v = result.q, (result.q - q) / DT


def exact(program: Program) -> float:
    """The least cost, by an active-set method on ½ |Lᵀd + L⁻¹g|²."""
    L = np.linalg.cholesky(program.H)
    bounds = (program.lower - program.q, program.upper - program.q)
    d = lsq_linear(L.T, -np.linalg.solve(L, program.gradient), bounds, method="bvls", tol=1e-15, max_iter=200).x
    return program.f + float(program.gradient.dot(d) + 0.5 * d.dot(program.H.dot(d)))


def contenders() -> dict[str, StepProgram]:
    """A program for each solver, Clarabel first as it is used and then at its default tolerances."""

    def with_solver(solver: SolverInterface, **values: float) -> StepProgram:
        program, options = StepProgram(6), SolverOptions()
        for name, value in values.items():
            options.SetOption(solver.solver_id(), name, value)
        program._solver, program._options = solver, options
        return program

    return {
        "Clarabel": StepProgram(6),
        "Clarabel, default tolerances": with_solver(ClarabelSolver()),
        "OSQP, 1e-10": with_solver(OsqpSolver(), eps_abs=1e-10, eps_rel=1e-10, polishing=0),
        "OSQP, 1e-8": with_solver(OsqpSolver(), eps_abs=1e-8, eps_rel=1e-8, polishing=0),
        "SCS": with_solver(ScsSolver()),
        "CLP": with_solver(ClpSolver()),
        "NLopt": with_solver(NloptSolver()),
        "SNOPT": with_solver(SnoptSolver()),
        "IPOPT": with_solver(IpoptSolver()),
    }


def compare(every: int) -> list[Row]:
    """Times, failures and gaps of all solvers on the same programs."""
    rng = np.random.default_rng(0)
    field = contenders()
    names = list(field)
    times: dict[str, list[float]] = {name: [] for name in names}
    gaps: dict[str, list[float]] = {name: [] for name in names}
    for program in programs(every):
        best = exact(program)
        for index in rng.permutation(len(names)):
            name = names[index]
            field[name].begin_tick(program.q, program.lower, program.upper)
            begin = time.thread_time()
            step = field[name].solve(program.f, program.gradient, program.H, program.q, [])
            times[name].append(time.thread_time() - begin)
            if step is not None:
                gaps[name].append((step.cost - best) / max(abs(best), _COST_FLOOR))
    rows = []
    for name in names:
        spent, gap = 1e6 * np.array(times[name]), np.array(gaps[name])
        figures = {
            ("programs", "1"): len(spent),
            ("failed", "1"): len(spent) - len(gap),
            ("time median", "us"): np.median(spent),
            ("time p99", "us"): np.percentile(spent, 99),
            ("time max", "us"): spent.max(),
            ("gap within 1e-6", "%"): 100 * np.sum(gap <= 1e-6) / len(spent),
            ("gap max", "1"): gap.max(initial=0.0),
        }
        rows += [Row("solvers", name, metric, float(value), unit) for (metric, unit), value in figures.items()]
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--every", type=int, default=10, help="take every n-th tick")
    parser.add_argument("--output", type=Path, default=Path("build/bench-ik-solvers.csv"))
    arguments = parser.parse_args()
    logging.getLogger("drake").setLevel(logging.ERROR)
    rows = compare(arguments.every)
    write_csv(arguments.output, rows)
    print_table(rows)


if __name__ == "__main__":
    main()
