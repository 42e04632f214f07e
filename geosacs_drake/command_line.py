"""What all commands share: options read by tyro, one clear line for input that cannot be used, the exit status."""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import NoReturn

import tyro

from canal.errors import GeosacsError, InputError


class ExitStatus(IntEnum):
    """What a command leaves with."""

    DONE = 0
    """The task was done."""
    NOT_DONE = 1
    """The task was not done."""
    BAD_INPUT = 2
    """Input that cannot be used; one line on standard error says what and how to mend it."""


def parse_options[T](options_type: type[T], prog: str, arguments: Sequence[str] | None = None) -> T:
    """Read the command line into a dataclass.

    Raises:
        InputError: an option that is unknown or has a value that it cannot take.
    """
    caught = io.StringIO()
    try:
        with contextlib.redirect_stderr(caught):
            return tyro.cli(options_type, prog=prog, args=arguments)
    except SystemExit as error:
        if not error.code:
            raise
        raise InputError(f"{_first_sentence(caught.getvalue())}; see {prog} --help") from None


def _first_sentence(box: str) -> str:
    """What tyro draws as a box of several lines, as one line: the box's first paragraph."""
    words: list[str] = []
    for line in box.splitlines()[1:]:
        text = line.strip("│ ")
        if not text or set(text) <= {"─", "╰", "╯"}:
            break
        words.append(text)
    return " ".join(words).rstrip(".") or "the options cannot be read"


def end(main: Callable[[], ExitStatus], prog: str) -> NoReturn:
    """Run a command's `main` and leave with its status; an error of ours becomes one line and status 2."""
    try:
        status = main()
    except GeosacsError as error:
        print(f"{prog}: {error}", file=sys.stderr)
        status = ExitStatus.BAD_INPUT
    except KeyboardInterrupt:
        print(f"{prog}: stopped", file=sys.stderr)
        status = ExitStatus.NOT_DONE
    sys.exit(int(status))
