"""Random sticks, scenarios and canals, for as long as one likes: `make fuzz ARGS="--seconds 7200"`.

Four parts: *navigation* (steps along random canals), *run* (whole runs in the simulation), *canal* (learned, saved,
edited, travelled) and *scenario* (YAML that somebody got wrong). A case is made from its seed alone. Cases run in
another process, which is ended and started anew when one hangs or takes it down. Every failure is printed with the
command that repeats it; the exit status is 1 when there was one.
"""

from __future__ import annotations

import argparse
import faulthandler
import importlib
import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from benchmarks.acceptance.schedule import ONE_THREAD, ROOT
from canal.errors import InputError

PARTS = {
    "navigation": ("benchmarks.fuzz.navigation", 60.0, 400),
    "run": ("benchmarks.fuzz.runs", 600.0, 20),
    "canal": ("benchmarks.fuzz.canals", 120.0, 200),
    "scenario": ("benchmarks.fuzz.scenarios", 60.0, 200),
}
"""By name: the module whose `case(seed)` tries one, the seconds of processor time after which a case hangs, and the
cases of a process."""
ASLEEP = 10.0
"""Times those seconds, by the clock, after which a case that waits for something is taken to hang."""
TURN_S = 60.0
"""With --part all each part gets so many seconds, then the next."""
STARTING_S = 60.0
"""What a process may take to start, on a busy machine."""


@dataclass
class Outcome:
    """What became of one case."""

    part: str
    seed: int
    kind: str
    """`ok`, `refused` (an InputError, which says why) or `FAILED`."""
    words: str
    seconds: float = 0.0

    @property
    def command(self) -> str:
        """What repeats it."""
        return f"python -m benchmarks.fuzz --part {self.part} --seed {self.seed} --cases 1"


@dataclass
class Tally:
    """What was tried in a part, and what fell."""

    cases: int = 0
    refused: int = 0
    seconds: float = 0.0
    slowest: float = 0.0
    tried: Counter[str] = field(default_factory=Counter)
    failed: list[Outcome] = field(default_factory=list)

    def add(self, outcome: Outcome) -> None:
        """Count a case."""
        self.cases += 1
        self.seconds += outcome.seconds
        self.slowest = max(self.slowest, outcome.seconds)
        self.refused += outcome.kind == "refused"
        if outcome.kind == "FAILED":
            self.failed.append(outcome)
        else:
            self.tried[outcome.words if outcome.kind == "ok" else f"refused: {_pattern(outcome.words)}"] += 1


def _pattern(words: str) -> str:
    """A message with its numbers taken out, to count its kind."""
    return " ".join("#" if any(c.isdigit() for c in word) else word for word in words.split())[:110]


def main(arguments: Sequence[str] | None = None) -> int:
    """Fuzz as the command line says; the exit status."""
    parser = argparse.ArgumentParser(prog="fuzz", description=__doc__)
    parser.add_argument("--seconds", type=float, default=600.0, help="how long")
    parser.add_argument("--seed", type=int, default=0, help="of the first case; the next has the next seed")
    parser.add_argument("--part", choices=(*PARTS, "all"), default="all")
    parser.add_argument("--cases", type=int, help="at most so many, in this process, with a traceback where one falls")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--output", type=Path, default=Path("build/fuzz.txt"), help="where failures are written, too")
    options = parser.parse_args(arguments)
    parts = list(PARTS) if options.part == "all" else [options.part]
    if options.child:
        return _child(parts[0], options.seed, PARTS[parts[0]][2])
    if options.cases is not None:
        outcomes = [tried(part, options.seed + k) for part in parts for k in range(options.cases)]
        for outcome in outcomes:
            print(f"{outcome.part} {outcome.seed}: {outcome.kind}, {outcome.words}")
        return int(any(outcome.kind == "FAILED" for outcome in outcomes))
    tallies = fuzz(parts, options.seed, options.seconds, options.output)
    print("\n".join(table(tallies)))
    return int(any(tally.failed for tally in tallies.values()))


def tried(part: str, seed: int) -> Outcome:
    """Try one case in this process."""
    begin = time.monotonic()
    try:
        kind, words = "ok", importlib.import_module(PARTS[part][0]).case(seed)
    except InputError as error:
        kind, words = "refused", str(error)
        if "\n" in words or len(words) > 1000:
            kind, words = "FAILED", f"an error of {len(words)} letters in {words.count(chr(10)) + 1} lines: {words}"
    except (Exception, SystemExit):
        kind, words = "FAILED", traceback.format_exc()
    return Outcome(part, seed, kind, words, time.monotonic() - begin)


def fuzz(parts: list[str], seed: int, seconds: float, output: Path) -> dict[str, Tally]:
    """Try cases of all parts in turns until the time is up.

    Args:
        parts: names of parts.
        seed: of each part's first case.
        seconds: how long.
        output: gets each failure as it is found.

    Returns:
        What was tried, by part.
    """
    output.parent.mkdir(parents=True, exist_ok=True)
    tallies = {part: Tally() for part in parts}
    end = time.monotonic() + seconds
    turn = min(TURN_S, seconds / len(parts))
    while time.monotonic() < end:
        for part in parts:
            tally, until = tallies[part], min(time.monotonic() + turn, end)
            if time.monotonic() >= end:
                break
            for outcome in stream(part, seed + tally.cases, until):
                tally.add(outcome)
                if outcome.kind == "FAILED":
                    text = f"{outcome.command}\n{outcome.words.rstrip()}\n"
                    print(text, flush=True)
                    with output.open("a") as file:
                        file.write(text + "\n")
            left = max(0.0, end - time.monotonic())
            fell = f"{len(tally.failed)} fell, " if tally.failed else ""
            print(f"{part}: {tally.cases} cases, {fell}{left:.0f} s left", file=sys.stderr, flush=True)
    return tallies


def stream(part: str, seed: int, until: float) -> Iterator[Outcome]:
    """Cases from `seed` on in another process, until the clock says `until`; one that hangs ends that process."""
    patience = ASLEEP * PARTS[part][1]
    while time.monotonic() < until:
        command = [sys.executable, "-m", "benchmarks.fuzz", "--child", "--part", part, "--seed", str(seed)]
        environment = os.environ | ONE_THREAD
        pipe = subprocess.PIPE
        process = subprocess.Popen(command, cwd=ROOT, stdout=pipe, stderr=pipe, text=True, env=environment)
        lines: queue.Queue[str | None] = queue.Queue()
        errors: list[str] = []
        readers = [
            threading.Thread(target=_read_lines, args=(process.stdout, lines), daemon=True),
            threading.Thread(target=lambda pipe, to: to.extend(pipe), args=(process.stderr, errors), daemon=True),
        ]
        for reader in readers:
            reader.start()
        try:
            while True:
                outcome = _next(part, seed, lines, patience)
                if outcome is None:  # it has done its share
                    break
                ended = outcome.kind == "FAILED" and not outcome.words
                if ended:
                    process.kill()
                    process.wait()
                    readers[1].join(5.0)
                    hung = outcome.seconds >= patience or process.returncode == -signal.SIGPROF
                    how = "hung" if hung else f"took the process down ({process.returncode})"
                    outcome.words = how + "\n" + "".join(errors[-30:])
                yield outcome
                seed += 1
                if ended or time.monotonic() >= until:
                    break
        finally:
            process.kill()
            process.wait()


def _next(part: str, seed: int, lines: queue.Queue[str | None], patience: float) -> Outcome | None:
    """The next outcome; without words where the case hung or its process died; None where its process is through."""
    try:
        line = lines.get(timeout=patience + STARTING_S)
    except queue.Empty:
        return Outcome(part, seed, "FAILED", "", patience)
    if line is None:
        return Outcome(part, seed, "FAILED", "")
    if line.strip() == "through":
        return None
    try:
        return Outcome(**json.loads(line))
    except ValueError:  # something else printed to standard output
        return _next(part, seed, lines, patience)


def _read_lines(pipe: Iterable[str], lines: queue.Queue[str | None]) -> None:
    for line in pipe:
        lines.put(line)
    lines.put(None)


def _child(part: str, seed: int, cases: int) -> int:
    # What hangs is ended in processor time, since others may use the machine; it says first where it was.
    faulthandler.register(signal.SIGPROF, chain=True)
    for k in range(cases):
        signal.setitimer(signal.ITIMER_PROF, PARTS[part][1])
        print(json.dumps(tried(part, seed + k).__dict__), flush=True)
    print("through", flush=True)
    return 0


def table(tallies: dict[str, Tally]) -> list[str]:
    """What was tried and what fell."""
    lines = [f"{'part':12}{'cases':>8}{'refused':>9}{'fell':>6}{'slowest':>10}"]
    for part, tally in tallies.items():
        lines.append(f"{part:12}{tally.cases:8}{tally.refused:9}{len(tally.failed):6}{tally.slowest:8.1f} s")
        lines += [f"  {count:6} {words}" for words, count in tally.tried.most_common(12)]
        lines += [f"  FELL   {outcome.command}" for outcome in tally.failed]
    return lines


if __name__ == "__main__":
    sys.exit(main())
