"""Random ticks of every kind of nonsense, and what must hold after each."""

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.ik.cases import pose_of
from benchmarks.table import Row
from diagrams.ik.options import IkStatus
from diagrams.ik.solver import IkSolver

_BAD = np.array([np.nan, np.inf, -np.inf, 1e300, -1e300, 1e-300, 0.0, -1.0])


def fuzz(solver: IkSolver, ticks: int, seed: int = 0) -> list[Row]:
    """Chained ticks with jumping and broken targets, weights, starts and periods; raises nothing by itself."""
    rng = np.random.default_rng(seed)
    q, v, X = 0.5 * (solver.q_min + solver.q_max), np.zeros(solver.n), _pose(solver, rng)
    exceptions = not_finite = 0
    step_excess = limit_excess = -np.inf
    statuses = np.zeros(len(IkStatus), dtype=int)
    for _ in range(ticks):
        dice = rng.random()
        if dice < 0.05:
            X = _pose(solver, rng)
        elif dice < 0.5:
            X = X + rng.normal(scale=0.01, size=7)
        w = rng.choice([0.0, 0.1, 1.0, 15.0, 1e6, -3.0, np.nan, np.inf, 1e300])
        weight = np.array([w]) if rng.random() < 0.1 else float(w)
        dt = 0.01 if rng.random() < 0.9 else float(rng.choice([0.001, 0.1, 1.0, 0.0, -1.0, np.nan, np.inf, 1e300]))
        if rng.random() < 0.003:
            q = q + rng.normal(scale=3.0, size=solver.n)
        q_given, v_given = q.copy(), v.copy() if rng.random() < 0.7 else None
        for values in (q_given, v_given):
            if values is not None and rng.random() < 0.003:
                values[rng.integers(solver.n)] = rng.choice(_BAD)
        try:
            result = solver.solve(X, weight, q_given, dt, v_given)
        except (Exception, SystemExit):
            exceptions += 1
            continue
        statuses[result.status] += 1
        not_finite += not np.all(np.isfinite(result.q))
        if np.all(np.abs(q_given) < 1e9):
            allowed = solver.v_max * (dt if np.isfinite(dt) and dt > 0.0 else 0.0)
            step_excess = max(step_excess, float((np.abs(result.q - q_given) - allowed).max()))
            before, after = (
                np.maximum(0.0, np.maximum(solver.q_min - p, p - solver.q_max)) for p in (q_given, result.q)
            )
            limit_excess = max(limit_excess, float((after - np.maximum(before - allowed, 0.0)).max()))
            v = np.clip((result.q - q_given) / 0.01, -solver.v_max, solver.v_max)
        q = result.q if np.all(np.abs(result.q) < 100.0) else 0.5 * (solver.q_min + solver.q_max)
    rows = [
        Row("fuzz", "this", "ticks", ticks, "1"),
        Row("fuzz", "this", "exceptions", exceptions, "1"),
        Row("fuzz", "this", "not finite", not_finite, "1"),
        Row("fuzz", "this", "largest step over v dt", step_excess, "rad"),
        Row("fuzz", "this", "largest excess over limits", limit_excess, "rad"),
    ]
    return rows + [Row("fuzz", "this", s.name.lower().replace("_", " "), int(statuses[s]), "1") for s in IkStatus]


def _pose(solver: IkSolver, rng: np.random.Generator) -> np.ndarray:
    """A pose that the arm can take, or one of many that it cannot."""
    X = pose_of(solver, rng.uniform(solver.q_min, solver.q_max))
    kind = rng.integers(12)
    if kind == 0:
        X[:3] = rng.normal(scale=2.0, size=3)
    elif kind == 1:
        X = np.array([0.0, 0.0, rng.choice([-2.0, 3.0, 1.6445]), 1.0, 0.0, 0.0, 0.0])
    elif kind == 2:
        X[3:] = rng.normal(size=4)
    elif kind == 3:
        X[rng.integers(7)] = rng.choice(_BAD)
    elif kind == 4:
        X[3:] *= rng.choice([1e-300, 1e-5, 1e5, 0.0])
    elif kind == 5:
        X *= 1e6
    elif kind == 6:
        X[3:] = (Rotation.from_rotvec([np.pi, 0, 0]) * Rotation.from_quat(X[3:], scalar_first=True)).as_quat(
            scalar_first=True
        )
    return X
