"""The benchmark's own parts: cases, the race among what is installed, fuzzing, the table."""

import csv
from pathlib import Path

import numpy as np
import pytest
from ik_arm import Q_START, TCP, lio_plant

from benchmarks.bench_ik import race, summarize
from benchmarks.ik.cases import Case, adversarial_cases, densify
from benchmarks.ik.fuzz import fuzz
from benchmarks.ik.rivals import contenders
from benchmarks.table import Row, print_table, write_csv
from diagrams.ik.solver import IkSolver


@pytest.fixture(scope="module")
def solver() -> IkSolver:
    return IkSolver(lio_plant(), TCP)


def test_a_thousand_fuzzed_ticks_are_survived(solver: IkSolver) -> None:
    figures = {row.metric: row.value for row in fuzz(solver, 1000, seed=3)}
    assert figures["exceptions"] == figures["not finite"] == 0
    assert figures["largest step over v dt"] <= 1e-12
    assert figures["largest excess over limits"] <= 1e-12
    assert sum(figures[name] for name in ("converged", "at bound", "out of reach", "held")) == 1000


def test_nobody_beats_this_solver_on_a_path_of_the_arm(solver: IkSolver) -> None:
    case = next(iter(adversarial_cases(solver)))
    front = Case("front", case.poses[:40] * [0.0, 0.1, 1.0, 1, 1, 1, 1], 1.0, Q_START)
    field = contenders(solver)
    assert {"this", "scipy L-BFGS-B", "Drake IK, SNOPT"} <= set(field)
    samples = race(solver, field, [front], np.random.default_rng(0), every=8)
    assert max(samples["this"]["gap"]) < 1e-6
    assert max(samples["this"]["bound violation"]) <= 1e-12
    rows = {(row.contender, row.metric): row.value for row in summarize("front", samples)}
    assert rows["this", "failed"] == 0.0
    assert rows["scipy L-BFGS-B", "gap median"] < 1e-3


def test_samples_at_20_hz_become_ticks_at_100_hz() -> None:
    position = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.2, 0.0]])
    poses = densify(position, np.array([[1.0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]]))
    assert poses.shape == (10, 7)
    np.testing.assert_allclose(poses[5, :3], position[1], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(poses[:, 3:], axis=1), 1.0)


def test_the_table_is_written_with_the_columns_that_others_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [Row("case", "this", "time median", 61.5, "us")]
    write_csv(tmp_path / "build" / "bench-x.csv", rows)
    with (tmp_path / "build" / "bench-x.csv").open() as file:
        assert list(csv.reader(file)) == [
            ["case", "contender", "metric", "value", "unit"],
            ["case", "this", "time median", "61.5", "us"],
        ]
    print_table(rows)
    assert "61.5" in capsys.readouterr().out
