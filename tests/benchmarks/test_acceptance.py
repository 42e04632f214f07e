"""The acceptance table: what it wants, what it does with figures that are missing, and how it ends."""

import csv
import json
import math
import os
from pathlib import Path

import pytest
from acceptance_jobs import failing, lingering, square

from benchmarks.acceptance import __main__ as acceptance
from benchmarks.acceptance import schedule
from benchmarks.acceptance.check import Bound, Check, Count, Job, Worst, at_least, at_most, exactly
from benchmarks.acceptance.registry import all_checks
from benchmarks.acceptance.schedule import run_jobs


@pytest.fixture(autouse=True)
def _jobs_are_found(monkeypatch):
    """`acceptance_jobs`, by the processes that run them."""
    paths = [str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, paths)))


@pytest.mark.parametrize(
    ("bound", "good", "bad"),
    [(at_most(5), [5, -1], [5.001, math.nan]), (at_least(2), [2, 9], [1.9, math.nan]), (exactly(0), [0], [1e-300])],
)
def test_a_bound_is_met_up_to_itself_and_never_by_nan(bound, good, bad):
    assert all(map(bound.met, good))
    assert not any(map(bound.met, bad))


def test_the_worst_of_several_figures_is_judged():
    assert at_most(5).worst([1, 7, 3]) == 7
    assert at_least(5).worst([1, 7, 3]) == 1
    assert exactly(4).worst([4, 5, 2]) == 2
    assert math.isnan(at_most(5).worst([1, math.nan]))
    assert Worst("a", "x", at_most(5)).judge([{"x": 1}, {"x": 5}]).verdict == "ok"
    assert Worst("a", "x", at_most(5)).judge([{"x": 1}, {"x": 6}]).verdict == "SHORT"


def test_a_figure_that_is_missing_falls_short():
    row = Worst("a", "x", at_most(5)).judge([{"x": 1}, {}])
    assert row.verdict == "SHORT"
    assert "1 of 2" in row.seen
    assert Worst("a", "x", at_most(5)).judge([{}]).verdict == "SHORT"
    assert Count("a", "x").judge([{"x": 1.0}, {}])[1:] == ("2 of 2", "1 of 2", "SHORT")
    assert Count("a", "x", 0.9).judge([{"x": 1.0}] * 18 + [{}, {"x": 0.0}])[1:] == ("18 of 20", "18 of 20", "ok")
    within = Count("a", "x", among="y")
    assert within.judge([{"x": 1.0, "y": 1.0}, {"x": 0.0, "y": 0.0}])[1:] == ("1 of 1", "1 of 1", "ok")
    assert within.judge([{"x": 1.0, "y": 1.0}, {}])[1:] == ("2 of 2", "1 of 2", "SHORT"), "what failed counts"


def test_jobs_run_in_processes_of_their_own_and_one_that_fails_harms_no_other(tmp_path):
    jobs = [Job(square, (3,), 0.1), Job(failing, ("exit",), 0.3), Job(failing, ("loud",), 0.2), Job(square, (-2,), 0.1)]
    seen = []
    found = run_jobs(
        jobs, at_a_time=1, folder=tmp_path, report=lambda job, _, failure: seen.append((job.name, failure))
    )
    assert [found[k].get("square") for k in range(4)] == [9, None, None, 4]
    assert found[0]["threads"] == 1, "one thread of linear algebra a job"
    assert [name for name, failure in seen if failure] == ["failing exit", "failing loud"], "the longest first"
    assert "RuntimeError: loud" in (tmp_path / "failing-loud.txt").read_text()


def test_a_job_that_hangs_is_ended_with_what_it_has_started(tmp_path, monkeypatch):
    monkeypatch.setattr(schedule, "AT_LEAST", 0.0)
    monkeypatch.setattr(schedule, "PATIENCE", 1.0)
    named = tmp_path / "pid"
    job = Job(lingering, (str(named),), 0.15)
    figures, failure = schedule.run_job(job, tmp_path / "out.txt")
    assert figures == {}
    assert failure.startswith("hung, ended after 9 s")
    child = Path(f"/proc/{named.read_text()}")
    ended = not child.exists() or "Z" in (child / "stat").read_text().rsplit(")", 1)[1].split()[0]
    assert ended, "the command goes on, and takes the time of the jobs that follow"


def test_every_check_can_be_run_as_it_is_declared():
    checks = all_checks()
    assert len({check.name for check in checks}) == len(checks)
    for check in checks:
        assert check.lines
        assert check.jobs
        assert check.quick <= len(check.jobs)
        for job in check.jobs:
            assert json.loads(json.dumps(job.arguments)) == list(job.arguments), "they go to a process as JSON"
            assert job.function.__qualname__ == job.function.__name__, "it is found at the top of its module"
    assert sum(job.minutes for check in checks for job in check.jobs) < 60, "half an hour on two cores"


@pytest.fixture
def two_checks(monkeypatch):
    checks = [
        Check("squares", "0", [Job(square, (k,), 0.1) for k in (1, 2)], (Worst("square", "square", at_most(4)),)),
        Check("goods", "0", [Job(square, (k,), 0.1) for k in (-1, 1)], (Count("good", "good"),), alone=True),
        Check("absent", "0", [Job(failing, ("loud",), 0.1)], (Count("good", "good"),), missing="no such thing here"),
    ]
    monkeypatch.setattr(acceptance, "all_checks", lambda: checks)


@pytest.mark.usefixtures("two_checks")
def test_one_table_in_words_and_as_a_file_and_status_1_where_a_line_falls_short(tmp_path, capsys):
    path = tmp_path / "build" / "acceptance.csv"
    assert acceptance.main(["--output", str(path), "--jobs", "1"]) == 1
    out = capsys.readouterr().out
    assert "no such thing here" in out.split("Not looked at:")[1]
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["line"], row["verdict"]) for row in rows] == [
        ("squares: square", "ok"),
        ("goods: good", "SHORT"),
        ("absent: good", "not looked at"),
        ("this table", "ok"),
    ]
    assert rows[0]["wanted"] == "≤ 4"
    assert rows[1]["seen"] == "1 of 2"
    assert list(rows[0]) == ["line", "wanted", "seen", "verdict"]


@pytest.mark.usefixtures("two_checks")
def test_part_of_it_can_be_run(tmp_path, capsys):
    path = tmp_path / "acceptance.csv"
    assert acceptance.main(["--output", str(path), "--only", "squ*", "--quick"]) == 0
    out = capsys.readouterr().out
    assert "1 runs" in out
    assert "--quick" in out.split("Not looked at:")[1]
    assert acceptance.main(["--only", "nonsense"]) == 2
    assert acceptance.main(["--list"]) == 0


def test_a_bound_says_what_it_wants():
    assert str(Bound("≤", 5, "mm")) == "≤ 5 mm"
