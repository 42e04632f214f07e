"""How good learned canals are: the table of `benchmarks.canal_quality`, its bounds and figures."""

from __future__ import annotations

from collections.abc import Callable

from benchmarks import canal_quality
from benchmarks.acceptance.check import Check, Figures, Job, Worst, at_most, exactly
from benchmarks.canal_quality import Figure

TABLES: dict[str, Callable[[], list[Figure]]] = {
    "recorded": lambda: canal_quality.of_recorded(canal_quality.recorded()),
    "generated": canal_quality.of_generated,
    "retargeted": canal_quality.of_retargeting,
}


def quality(table: str) -> Figures:
    """Of one table: how many rows it has, how many do not hold, and the nearest to its bound, as a share of it."""
    rows = TABLES[table]()
    canal_quality.print_figures(rows)
    bounded = [row for row in rows if 0 < row.wanted < float("inf")]
    return {
        "rows": len(rows),
        "rows that do not hold": sum(not row.met for row in rows),
        "nearest": max(row.seen / row.wanted for row in bounded),
    }


def checks() -> list[Check]:
    """One check a table."""
    lines = (
        Worst("rows that do not hold", "rows that do not hold", exactly(0)),
        Worst("nearest to its bound, of it", "nearest", at_most(1.0)),
    )
    absent = "" if len(canal_quality.recorded()) == 2 else f"no recordings in {canal_quality.RECORDED}"
    return [
        Check("canals, recorded", "3", [Job(quality, ("recorded",), 0.1)], lines, missing=absent),
        Check("canals, generated (30 seeds)", "3", [Job(quality, ("generated",), 1.0)], lines),
        Check("canals, retargeted (120)", "3", [Job(quality, ("retargeted",), 0.5)], lines),
    ]
