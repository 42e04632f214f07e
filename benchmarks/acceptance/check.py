"""Checks as data: what is run, for how long, and what its figures must be."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

Figures = Mapping[str, float]
"""What a job measured, by name. What it could not measure is left out, and falls short."""


@dataclass(frozen=True)
class Bound:
    """What a figure must be: at most, at least or exactly `value`."""

    sense: Literal["≤", "≥", "="]
    value: float
    unit: str = ""

    def met(self, seen: float) -> bool:
        """Whether `seen` keeps to it; what is not a number never does."""
        if self.sense == "=":
            return seen == self.value
        return seen <= self.value if self.sense == "≤" else seen >= self.value

    def worst(self, values: Sequence[float]) -> float:
        """Of several figures the one that is furthest from keeping to it."""
        if any(math.isnan(v) for v in values):
            return math.nan
        if self.sense == "=":
            return max(values, key=lambda v: abs(v - self.value))
        return max(values) if self.sense == "≤" else min(values)

    def __str__(self) -> str:
        return f"{self.sense} {shown(self.value, self.unit)}"


def at_most(value: float, unit: str = "") -> Bound:
    """A figure of up to `value`."""
    return Bound("≤", value, unit)


def at_least(value: float, unit: str = "") -> Bound:
    """A figure of `value` or more."""
    return Bound("≥", value, unit)


def exactly(value: float, unit: str = "") -> Bound:
    """A figure of `value` to the last bit: counts, and what must not differ."""
    return Bound("=", value, unit)


def shown(value: float, unit: str = "") -> str:
    """A figure as the table shows it."""
    return f"{value:.4g} {unit}".strip()


@dataclass(frozen=True)
class Job:
    """A call of `function(*arguments)` in a process of its own; it returns figures."""

    function: Callable[..., Figures]
    """At the top of a module. Its arguments are plain: strings, numbers, None."""
    arguments: tuple[Any, ...]
    minutes: float
    """What it takes alone on the machine where it was last measured; only the order of jobs comes from it."""

    @property
    def name(self) -> str:
        """As progress and the folder of outputs name it."""
        return " ".join([self.function.__name__, *map(str, self.arguments)])


class Verdict(NamedTuple):
    """A row of the table."""

    line: str
    wanted: str
    seen: str
    verdict: Literal["ok", "SHORT", "not looked at"]


@dataclass(frozen=True)
class Worst:
    """A line about the worst of all jobs' figures of one name."""

    name: str
    figure: str
    wanted: Bound

    def judge(self, results: Sequence[Figures]) -> Verdict:
        """Its row, given what each job measured."""
        values = [figures[self.figure] for figures in results if self.figure in figures]
        missing = len(results) - len(values)
        seen = shown(self.wanted.worst(values), self.wanted.unit) if values else ""
        if missing:
            seen = f"{seen} (no figure from {missing} of {len(results)})".strip()
        ok = bool(values) and not missing and self.wanted.met(self.wanted.worst(values))
        return Verdict(self.name, str(self.wanted), seen, "ok" if ok else "SHORT")


@dataclass(frozen=True)
class Count:
    """A line about how many jobs' figure is not zero."""

    name: str
    figure: str
    share: float = 1.0
    """Of the jobs that must have it."""
    among: str = ""
    """Only jobs with this figure count; empty: all. A job that failed, and has no figures, always counts."""

    def judge(self, results: Sequence[Figures]) -> Verdict:
        """Its row, given what each job measured."""
        results = [figures for figures in results if not self.among or figures.get(self.among, 1.0)]
        n, count = len(results), sum(bool(figures.get(self.figure, 0.0)) for figures in results)
        wanted = math.ceil(self.share * n - 1e-9)
        return Verdict(self.name, f"{wanted} of {n}", f"{count} of {n}", "ok" if n and count >= wanted else "SHORT")


@dataclass(frozen=True)
class Check:
    """Jobs, and the lines that their figures must keep to."""

    name: str
    section: str
    """Of the issue whose line it shows."""
    jobs: Sequence[Job]
    lines: Sequence[Worst | Count]
    quick: int = 1
    """Jobs that are run with --quick."""
    alone: bool = False
    """Whether its jobs are run with nothing beside them: those that look at the clock."""
    missing: str = ""
    """Why it cannot be run here; empty where it can."""

    def judge(self, results: Sequence[Figures]) -> list[Verdict]:
        """The rows of this check's lines, named by it."""
        return [row._replace(line=f"{self.name}: {row.line}") for row in (line.judge(results) for line in self.lines)]
