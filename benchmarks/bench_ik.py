"""Inverse kinematics against its rivals: `make bench-ik`, or `python -m benchmarks.bench_ik --help`.

In one process, at each tick, all contenders solve the same tick (same start, same target) in random order; then the
path goes on from the project's own answer. Once as fast as they can ("tight"), once with 1 ms of sleep before each
("paced"), which is how a controller meets them. The gap is to the best posture anybody found, polished.
"""

import argparse
import logging
import time
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from scipy.optimize import minimize

from benchmarks.ik.cases import DT, Case, adversarial_cases, demonstration_cases
from benchmarks.ik.collision_avoidance import collision_avoidance
from benchmarks.ik.fuzz import fuzz
from benchmarks.ik.rivals import SAME_OBJECTIVE, Contender, contenders
from benchmarks.table import Row, print_table, write_csv
from diagrams.ik.solver import IkSolver
from diagrams.ik.target import wanted_pose
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant

_GAP_FLOOR = 1e-9
_PACE = 1e-3
Samples = dict[str, dict[str, list[float]]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--every", type=int, default=20, help="let the rivals solve every n-th tick of a path")
    parser.add_argument("--paced", type=int, default=300, help="ticks of the paced comparison")
    parser.add_argument("--exact", type=int, default=10, help="check the gap on every n-th tick (1: on all)")
    parser.add_argument("--fuzz", type=int, default=10_000, help="fuzzed ticks (the acceptance run: 100000)")
    parser.add_argument("--output", type=Path, default=Path("build/bench-ik.csv"))
    arguments = parser.parse_args()

    logging.getLogger("drake").setLevel(logging.WARNING)  # Clarabel reports each step that it cannot improve
    solver = IkSolver(make_arm_plant(), TCP_FRAME)
    field = contenders(solver)
    rng = np.random.default_rng(0)
    demonstrations = list(demonstration_cases(solver))
    rows: list[Row] = []
    pooled: Samples = _empty()
    for case in demonstrations:
        print(f"racing on {case.name}, {len(case.poses)} ticks", flush=True)
        samples = race(solver, field, [case], rng, every=arguments.every)
        rows += summarize(case.name, samples)
        for name, metrics in samples.items():
            for metric, values in metrics.items():
                pooled[name][metric] += values
    rows += summarize("demonstrations, tight", pooled)
    ticks = sum(len(case.poses) for case in demonstrations)
    paced = race(solver, field, demonstrations, rng, every=max(ticks // arguments.paced, 1), pace=_PACE)
    rows += summarize("demonstrations, paced", paced)
    print("exactness", flush=True)
    rows += exactness(solver, demonstrations, arguments.exact)
    adversarial = race(solver, field, adversarial_cases(solver), rng, every=arguments.every)
    rows += summarize("adversarial, tight", adversarial)
    for name in field:
        for mode, samples in (("tight", pooled), ("paced", paced)):
            ratio = float(np.median(samples[name]["time"]) / np.median(samples["this"]["time"]))
            rows.append(Row(f"demonstrations, {mode}", name, "time over this", ratio, "1"))
    rows += collision_avoidance()
    rows += fuzz(solver, arguments.fuzz)
    write_csv(arguments.output, rows)
    print_table([row for row in rows if " w=" not in row.case])
    _plot(arguments.output.with_suffix(".png"), pooled, paced)
    print(f"written to {arguments.output} and {arguments.output.with_suffix('.png')}")


def _empty() -> Samples:
    return defaultdict(lambda: defaultdict(list))


def race(
    solver: IkSolver,
    field: dict[str, Contender],
    cases: Iterable[Case],
    rng: np.random.Generator,
    *,
    every: int,
    pace: float = 0.0,
) -> Samples:
    """By contender and metric: wall and processor time [s], gap [1], excess over bounds [rad], errors [m], [rad]."""
    samples = _empty()
    names = list(field)
    for case in cases:
        q, v = case.q_start, np.zeros(solver.n)
        for tick, X in enumerate(case.poses):
            if tick % every:
                q_next = solver.solve(X, case.weight, q, DT, v).q
            else:
                lower, upper = solver.box(q, DT)
                answers = {}
                for index in rng.permutation(len(names)):
                    name = names[index]
                    if pace:
                        time.sleep(pace)
                    begin, begin_cpu = time.perf_counter(), time.thread_time()
                    try:
                        answer = np.asarray(field[name](X, case.weight, q, v, lower, upper), dtype=float)
                    except Exception:  # mink and pink raise where their program has no solution
                        answer = np.full(solver.n, np.nan)
                    samples[name]["cpu"].append(time.thread_time() - begin_cpu)
                    samples[name]["time"].append(time.perf_counter() - begin)
                    answers[name] = answer
                _judge(solver, case, X, q, lower, upper, answers, samples)
                q_next = answers["this"]
            q, v = q_next, (q_next - q) / DT
    return samples


def _judge(
    solver: IkSolver,
    case: Case,
    X: np.ndarray,
    q: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    answers: dict[str, np.ndarray],
    samples: Samples,
) -> None:
    """Errors and gaps of one tick's answers."""
    costs = {}
    set_tick(solver, X, case.weight, q)
    for name, answer in answers.items():
        failed = not np.all(np.isfinite(answer))
        samples[name]["failed"].append(float(failed))
        if failed:
            continue
        excess = float(np.maximum(lower - answer, answer - upper).max())
        samples[name]["bound violation"].append(max(excess, 0.0))
        costs[name] = solver.objective.value(np.clip(answer, lower, upper))
        samples[name]["position error"].append(solver.objective.position_error)
        samples[name]["orientation error"].append(solver.objective.orientation_error)
    winner = min(costs, key=lambda name: costs[name])
    best = min(costs[winner], polish(solver, answers[winner], lower, upper))
    for name, cost in costs.items():
        samples[name]["gap"].append((cost - best) / max(best, _GAP_FLOOR))


def set_tick(solver: IkSolver, X: np.ndarray, w: float, q: np.ndarray) -> None:
    """Make the solver's objective that of a tick."""
    target = wanted_pose(X)
    assert target is not None
    solver.objective.set_target(*target, w, q)


def polish(solver: IkSolver, q: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> float:
    """The least cost that L-BFGS-B, at its tightest, still finds from q."""

    def both(x: np.ndarray) -> tuple[float, np.ndarray]:
        value = solver.objective.value(x)
        return value, solver.objective.gradient()

    options = {"ftol": 0.0, "gtol": 1e-13, "maxiter": 200}
    return float(
        minimize(both, np.clip(q, lower, upper), jac=True, bounds=np.column_stack((lower, upper)), options=options).fun
    )


def exactness(solver: IkSolver, cases: list[Case], every: int) -> list[Row]:
    """On every n-th tick of every case: the gap to the best of polished answers from here and from random starts."""
    rng = np.random.default_rng(2)
    gaps = []
    for case in cases:
        q, v = case.q_start, np.zeros(solver.n)
        for tick, X in enumerate(case.poses):
            result = solver.solve(X, case.weight, q, DT, v)
            if tick % every == 0:
                lower, upper = solver.box(q, DT)
                set_tick(solver, X, case.weight, q)
                best = min(polish(solver, start, lower, upper) for start in (result.q, rng.uniform(lower, upper)))
                best = min(best, result.cost)
                gaps.append((result.cost - best) / max(best, _GAP_FLOOR))
            q, v = result.q, (result.q - q) / DT
    return [
        Row("demonstrations, exactness", "this", "ticks", len(gaps), "1"),
        Row("demonstrations, exactness", "this", "gap within 1e-6", 100 * float(np.mean(np.array(gaps) <= 1e-6)), "%"),
        Row("demonstrations, exactness", "this", "largest gap", float(np.max(gaps)), "1"),
    ]


def summarize(case: str, samples: Samples) -> list[Row]:
    """Medians, 99th percentiles and worst values."""
    rows = []
    for name, metrics in samples.items():
        rows += [
            Row(case, name, f"{clock} {what}", 1e6 * float(np.percentile(metrics[clock], share)), "us")
            for clock in ("time", "cpu")
            for what, share in (("median", 50), ("p99", 99))
        ]
        rows += [
            Row(case, name, "failed", 100 * float(np.mean(metrics["failed"])), "%"),
        ]
        if not metrics["gap"]:
            continue
        rows += [
            Row(case, name, "gap median", float(np.median(metrics["gap"])), "1"),
            Row(case, name, "gap p99", float(np.percentile(metrics["gap"], 99)), "1"),
            Row(case, name, "bound violation max", float(np.max(metrics["bound violation"])), "rad"),
            Row(case, name, "position error median", 1e3 * float(np.median(metrics["position error"])), "mm"),
            Row(case, name, "position error p99", 1e3 * float(np.percentile(metrics["position error"], 99)), "mm"),
            Row(
                case,
                name,
                "orientation error median",
                float(np.degrees(np.median(metrics["orientation error"]))),
                "deg",
            ),
        ]
    return rows


def _plot(path: Path, tight: Samples, paced: Samples) -> None:
    """Times as boxes, tight and paced, and gaps beside them."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 4.5), layout="constrained")
    axes = figure.subplots(1, 3, sharey=True)
    names = sorted(tight, key=lambda name: -float(np.median(tight[name]["time"])))
    labels = [f"{name} *" if name in SAME_OBJECTIVE else name for name in names]
    panels = (
        (tight, "time", 1e6, "time of a tick, tight [µs]"),
        (paced, "time", 1e6, "time of a tick, paced at 1 ms [µs]"),
        (tight, "gap", 1.0, "gap to the best found [1]"),
    )
    for axis, (samples, metric, scale, title) in zip(axes, panels, strict=True):
        values = [scale * np.maximum(samples[name][metric], 1e-14) for name in names]
        axis.boxplot(values, orientation="horizontal", tick_labels=labels, whis=(1, 99), showfliers=False)
        axis.set(xscale="log", xlabel=title)
        axis.grid(axis="x", alpha=0.3)
    figure.suptitle("Demonstrations at w = 0.1, 1, 15; whiskers 1 and 99 %; * minimises this very objective")
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    main()
