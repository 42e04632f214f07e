"""`make acceptance`: every line that was shown once, wanted and seen; status 1 where one falls short.

`make acceptance ARGS="--list"`, `--only PATTERN`, `--quick`. Takes under half an hour on two cores. The table is
written to build/acceptance.csv too, and what each run printed to build/acceptance/.
"""

from __future__ import annotations

import argparse
import csv
import fnmatch
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from benchmarks.acceptance.check import Check, Figures, Job, Verdict
from benchmarks.acceptance.registry import NOT_LOOKED_AT, all_checks
from benchmarks.acceptance.schedule import run_jobs

ALLOWED_MINUTES = 30.0


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what the command line asks for; the exit status."""
    options = _parse(arguments)
    checks = [c for c in all_checks() if not options.only or any(_matches(c.name, p) for p in options.only)]
    if not checks:
        print(f"no check is called {' or '.join(options.only)}; --list shows them", file=sys.stderr)
        return 2
    if options.list:
        _list(checks)
        return 0
    begin = time.monotonic()
    jobs = {id(c): [] if c.missing else list(c.jobs[: c.quick] if options.quick else c.jobs) for c in checks}
    results: dict[int, list[Figures]] = {}
    for alone in (True, False):
        some = [c for c in checks if c.alone == alone]
        flat = [job for c in some for job in jobs[id(c)]]
        print(f"{len(flat)} runs, {1 if alone else options.jobs} at a time", flush=True)
        folder = options.output.parent / "acceptance"
        found = run_jobs(flat, at_a_time=1 if alone else options.jobs, folder=folder, report=_Progress(len(flat)))
        indices = iter(range(len(flat)))
        results |= {id(c): [found[next(indices)] for _ in jobs[id(c)]] for c in some}
    rows = [row for c in checks for row in _rows(c, results[id(c)])]
    minutes = (time.monotonic() - begin) / 60
    if not options.only and not options.quick:
        late = "ok" if minutes < ALLOWED_MINUTES else "SHORT"
        rows.append(Verdict("this table", f"< {ALLOWED_MINUTES:g} min", f"{minutes:.1f} min", late))  # type: ignore[arg-type]
    _write(options.output, rows)
    print("\n".join(_table(rows)))
    print(f"took {minutes:.1f} minutes; written to {options.output}")
    print("\n".join(_left_out(checks, options)))
    short = sum(row.verdict == "SHORT" for row in rows)
    print(f"{short} of {len(rows)} lines fall short" if short else f"all {len(rows)} lines hold")
    return 1 if short else 0


def _parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="acceptance", description=__doc__)
    parser.add_argument("--only", nargs="+", default=[], metavar="PATTERN", help="checks whose name has it (or fits *)")
    parser.add_argument("--list", action="store_true", help="show the checks and what they want; run nothing")
    parser.add_argument("--quick", action="store_true", help="a run or two of each check")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    parser.add_argument("--output", type=Path, default=Path("build/acceptance.csv"))
    options = parser.parse_args(arguments)
    if options.jobs < 1:
        parser.error(f"--jobs is {options.jobs}; give 1 or more")
    return options


def _matches(name: str, pattern: str) -> bool:
    return pattern in name or fnmatch.fnmatchcase(name, pattern)


def _list(checks: list[Check]) -> None:
    for check in checks:
        minutes = sum(job.minutes for job in check.jobs)
        print(f"{check.name} ({check.section}): {len(check.jobs)} runs, {minutes:.1f} min" + (" alone" * check.alone))
        for line in check.lines:
            wanted = getattr(line, "wanted", None) or f"in {100 * getattr(line, 'share', 1.0):.0f} %"
            print(f"  {line.name} {wanted}")
    print(f"{sum(j.minutes for c in checks for j in c.jobs):.0f} minutes of one core")


class _Progress:
    """Says after each run how it went."""

    def __init__(self, whole: int) -> None:
        self._whole, self._done = whole, 0

    def __call__(self, job: Job, seconds: float, failure: str) -> None:
        self._done += 1
        print(f"[{self._done}/{self._whole}] {seconds:4.0f} s  {job.name}  {failure}".rstrip(), flush=True)


def _rows(check: Check, results: list[Figures]) -> list[Verdict]:
    rows = check.judge(results)
    return [row._replace(seen=check.missing, verdict="not looked at") for row in rows] if check.missing else rows


def _table(rows: list[Verdict]) -> list[str]:
    """The rows under their header, columns aligned."""
    cells = [("line", "wanted", "seen", "verdict"), *rows]
    widths = [max(len(row[k]) for row in cells) for k in range(4)]
    return ["  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip() for row in cells]


def _write(path: Path, rows: list[Verdict]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    with temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(Verdict._fields)
        writer.writerows(rows)
    os.replace(temporary, path)


def _left_out(checks: list[Check], options: argparse.Namespace) -> list[str]:
    """What this table does not say."""
    lines = ["Not looked at:", *(f"- {line}" for line in NOT_LOOKED_AT)]
    lines += [f"- {check.name}: {check.missing}" for check in checks if check.missing]
    if options.only:
        lines.append(f"- every check that is not called {' or '.join(options.only)}")
    if options.quick:
        lines.append("- all but the first run or two of each check (--quick)")
    return lines


if __name__ == "__main__":
    sys.exit(main())
