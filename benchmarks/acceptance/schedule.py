"""Jobs as processes, some at a time, the longest first."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks.acceptance.check import Figures, Job

ROOT = Path(__file__).parents[2]
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Threads of linear algebra fight for the cores that the other job needs."""
PATIENCE, AT_LEAST = 8.0, 2.0
"""Times the minutes of a job, and minutes more, after which it is taken to hang, and is ended with all it started."""


def run_jobs(
    jobs: Sequence[Job],
    *,
    at_a_time: int,
    folder: Path,
    report: Callable[[Job, float, str], None] = lambda job, seconds, failure: None,
) -> dict[int, Figures]:
    """Run jobs and collect their figures; what a failed one left out is missing from them.

    Args:
        jobs: what to run.
        at_a_time: how many processes.
        folder: where each job's output goes, one file a job.
        report: called after each job with the seconds it took and why it failed (empty: it did not).

    Returns:
        Figures by the job's index in `jobs`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    longest_first = sorted(range(len(jobs)), key=lambda k: -jobs[k].minutes)

    def one(k: int) -> Figures:
        begin = time.monotonic()
        figures, failure = run_job(jobs[k], folder / f"{re.sub(r'[^A-Za-z0-9.-]+', '-', jobs[k].name)}.txt")
        report(jobs[k], time.monotonic() - begin, failure)
        return figures

    with ThreadPoolExecutor(at_a_time) as pool:
        return dict(zip(longest_first, pool.map(one, longest_first), strict=True))


def run_job(job: Job, output: Path) -> tuple[Figures, str]:
    """One job in a new process: its figures, and why it failed (empty: it did not). What it prints goes to `output`."""
    where = f"{job.function.__module__}:{job.function.__qualname__}"
    with tempfile.TemporaryDirectory() as scratch, output.open("w") as printed:
        answer = Path(scratch) / "figures.json"
        command = [sys.executable, "-m", "benchmarks.acceptance.job", where, json.dumps(job.arguments), str(answer)]
        patience = 60 * (AT_LEAST + PATIENCE * job.minutes)
        with subprocess.Popen(
            command,
            cwd=ROOT,  # where `benchmarks` is found
            env=os.environ | ONE_THREAD,
            stdin=subprocess.DEVNULL,
            stdout=printed,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        ) as process:
            try:
                status = process.wait(patience)
            except BaseException as error:  # a Ctrl-C does not reach the new session
                os.killpg(process.pid, signal.SIGKILL)  # with the commands that the job has started
                if not isinstance(error, subprocess.TimeoutExpired):
                    raise
                return {}, f"hung, ended after {patience:.0f} s; see {output}"
        if status or not answer.exists():
            return {}, f"ended with status {status}; see {output}"
        return json.loads(answer.read_text()), ""
