"""The files that a command leaves behind: checked before it works, each written on its own after it."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from canal.errors import InputError
from canal.files import check_output, identity
from geosacs_drake.process.command_line import one_line


@dataclass(frozen=True)
class Output:
    """A file that the command line asks for."""

    flag: str
    """The option that names it."""
    path: Path
    endings: tuple[str, ...]
    """What its name may end in; a pipe or a device may have any name."""


def check_outputs(outputs: Iterable[Output], inputs: Iterable[Path]) -> None:
    """Refuse, before anything is computed, what could not be written or would destroy something.

    Args:
        outputs: what the command will write.
        inputs: what it reads; names that lead nowhere are for whoever reads them.

    Raises:
        InputError: a wrong ending, a path that cannot be written, one file given twice or read by the same command.
    """
    taken: dict[object, str] = {}
    for path in inputs:
        if os.path.exists(path):
            taken.setdefault(identity(path), f"is read by the same command, as {path}")
    for output in outputs:
        try:
            _check_ending(output)
            check_output(output.path)
        except InputError as error:
            raise InputError(f"{output.flag} {error}") from None
        key = identity(output.path)
        if key is not None and key in taken:
            raise InputError(f"{output.flag} {output.path}: {taken[key]}; give another name")
        taken[key] = f"is {output.flag}, too"


def _check_ending(output: Output) -> None:
    try:
        special = not stat.S_ISREG(os.stat(output.path).st_mode)
    except OSError:
        special = False
    if not special and output.path.suffix.lower() not in output.endings:
        raise InputError(f"{output.path}: give a name that ends in {' or '.join(output.endings)}")


def write_each(writers: Sequence[tuple[str, Callable[[], object]]]) -> list[str]:
    """Call each writer, whatever becomes of the others.

    Args:
        writers: what is written, for the message, and how.

    Returns:
        A line for each that failed. Drake says some failures as `SystemExit`.
    """
    failures = []
    for what, write in writers:
        try:
            write()
        except (Exception, SystemExit) as error:
            ours = isinstance(error, InputError)
            failures.append(f"{what} {error}" if ours else f"{what}: not written, {type(error).__name__}: {error}")
    return failures


def say_failures(prog: str, failures: Sequence[str]) -> None:
    """Say on standard error what could not be written.

    Args:
        prog: the command's name.
        failures: one line for each file that could not be written.
    """
    for line in failures:
        print(f"{prog}: {one_line(line)}", file=sys.stderr)
