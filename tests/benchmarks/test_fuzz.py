"""A little of what `make fuzz` does for hours, and that it finds what is wrong and can say how to see it again."""

import dataclasses
import json
import math
import sys
import time

import numpy as np
import pytest

from benchmarks.fuzz import __main__ as fuzz
from benchmarks.fuzz import navigation as fuzz_navigation
from benchmarks.fuzz.options import random_options
from canal.learning_options import LearningOptions
from canal.navigation import NavigationOptions
from diagrams.ik.options import IkOptions
from diagrams.operator.options import OperatorOptions


@pytest.mark.parametrize(("part", "cases"), [("navigation", 10), ("canal", 3), ("scenario", 20), ("run", 1)])
def test_nothing_falls(part, cases):
    outcomes = [fuzz.tried(part, seed) for seed in range(cases)]
    fell = [f"{outcome.command}\n{outcome.words}" for outcome in outcomes if outcome.kind == "FAILED"]
    assert not fell, "\n".join(fell)
    assert any(outcome.kind == "ok" for outcome in outcomes)


def test_a_fault_is_found_and_repeated_by_its_seed(monkeypatch):
    def jumping(canal, state, joystick, dt, **more):
        after = right(canal, state, joystick, dt, **more)
        return dataclasses.replace(after, eta=after.eta + 1e-3) if after.running else after

    right = fuzz_navigation.step
    monkeypatch.setattr(fuzz_navigation, "step", jumping)
    first, again = fuzz.tried("navigation", 1), fuzz.tried("navigation", 1)
    assert first.kind == again.kind == "FAILED"
    assert first.words == again.words
    assert first.command.endswith("--part navigation --seed 1 --cases 1")


def test_options_stay_within_what_stands_at_their_fields():
    rng = np.random.default_rng(0)
    for start in (NavigationOptions(), LearningOptions(), OperatorOptions(), IkOptions()):
        seen = [random_options(start, rng, share=0.5) for _ in range(60)]  # made: so they are within
        numbers = [f.name for f in dataclasses.fields(start) if isinstance(getattr(start, f.name), float)]
        assert all(len({getattr(s, name) for s in seen}) > 5 for name in numbers), "each is tried"
        assert all(math.isfinite(getattr(s, name)) for s in seen for name in numbers)


@pytest.fixture
def process(tmp_path, monkeypatch):
    """Makes the fuzzer's other process one that prints lines and then does what it is told."""

    def make(lines: list[str], then: str) -> None:
        script = tmp_path / "python"
        body = "".join(f"echo '{line}'\n" for line in lines)
        script.write_text(f"#!/bin/sh\n{body}{then}\n")
        script.chmod(0o755)
        monkeypatch.setattr(sys, "executable", str(script))

    monkeypatch.setattr(fuzz, "STARTING_S", 1.0)
    monkeypatch.setitem(fuzz.PARTS, "canal", ("nothing", 0.1, 1))
    return make


def outcome(seed: int, kind: str = "ok") -> str:
    return json.dumps(fuzz.Outcome("canal", seed, kind, "words").__dict__)


def test_a_case_that_hangs_is_ended_and_counts_as_fallen(process, tmp_path):
    process([outcome(5)], "sleep 100")
    begin = time.monotonic()
    seen = [next(cases) for cases in [fuzz.stream("canal", 5, begin + 60)] for _ in range(2)]
    assert [(o.seed, o.kind) for o in seen] == [(5, "ok"), (6, "FAILED")]
    assert seen[1].words.startswith("hung")
    assert time.monotonic() - begin < 50


def test_a_case_that_takes_its_process_down_counts_as_fallen(process, tmp_path):
    process([outcome(5)], "echo broken >&2; exit 139")
    seen = [next(cases) for cases in [fuzz.stream("canal", 5, time.monotonic() + 60)] for _ in range(2)]
    assert seen[1].kind == "FAILED"
    assert "broken" in seen[1].words


def test_the_table_says_what_was_tried_and_what_fell(process, tmp_path, capsys):
    process([outcome(0), outcome(1, "FAILED")], "echo through; sleep 100")
    tallies = fuzz.fuzz(["canal"], 0, 2.0, tmp_path / "build" / "fuzz.txt")
    table = "\n".join(fuzz.table(tallies))
    assert tallies["canal"].cases >= 2
    assert "FELL   python -m benchmarks.fuzz --part canal --seed 1 --cases 1" in table
    assert "--seed 1 --cases 1" in (tmp_path / "build" / "fuzz.txt").read_text()
