"""The commands as a person types them, in a folder that is thrown away."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.canal_quality import ROOT


class Ended(NamedTuple):
    """A command that has ended."""

    status: int
    output: str
    errors: str
    seconds: float
    """Of processor time: others may use the machine."""


@contextmanager
def empty_folder() -> Iterator[Path]:
    """A folder to run commands in; gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="acceptance-") as name:
        yield Path(name)


def command(module: str, *arguments: object, folder: Path, patience: float = 1200.0) -> Ended:
    """Run `python -m geosacs_drake.MODULE arguments` in `folder`; one that hangs ends with status -1."""
    line = [sys.executable, "-m", f"geosacs_drake.{module}", *map(str, arguments)]
    begin = _spent()
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    try:
        ended = subprocess.run(
            line, cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=patience
        )
        status, output, errors = ended.returncode, ended.stdout, ended.stderr
    except subprocess.TimeoutExpired as late:
        status, output, errors = -1, late.stdout or b"", late.stderr or b""
    words = (output.decode(errors="replace"), errors.decode(errors="replace"))
    print(" ".join(line[2:]), f"-> {status}", *words, sep="\n", flush=True)
    return Ended(status, *words, _spent() - begin)


def _spent() -> float:
    """Processor time of the commands so far [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def summary_of(path: Path) -> dict[str, Any]:
    """A summary that was written."""
    return json.loads(path.read_text())


def log_of(path: Path) -> Mapping[str, np.ndarray]:
    """A log that was written."""
    with np.load(path, allow_pickle=False) as file:
        return {name: file[name] for name in file.files}
