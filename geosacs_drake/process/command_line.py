"""What all commands share: options read by tyro, one clear line for input that cannot be used, the exit status."""

from __future__ import annotations

import contextlib
import io
import re
import sys
from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import NoReturn

import tyro

from canal.errors import GeosacsError, InputError
from geosacs_drake.process.streams import unbroken_streams


class ExitStatus(IntEnum):
    """What a command leaves with."""

    DONE = 0
    """The task was done."""
    NOT_DONE = 1
    """The task was not done."""
    BAD_INPUT = 2
    """Input that cannot be used, a file that could not be written, or a run that something inside it ended; one line on
    standard error says what, and how to mend it."""


def parse_options[T](
    options_type: type[T], prog: str, arguments: Sequence[str] | None = None, default: T | None = None
) -> T:
    """Read the command line into a dataclass.

    Args:
        options_type: the dataclass.
        prog: the command's name, for messages.
        arguments: instead of the process's own.
        default: what options are that are not given; None for the dataclass's own defaults.

    Raises:
        InputError: an option that is unknown or has a value that it cannot take.
    """
    caught = io.StringIO()
    try:
        with contextlib.redirect_stderr(caught):
            given = tyro.MISSING_NONPROP if default is None else default
            return tyro.cli(options_type, prog=prog, args=arguments, default=given)
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
    # tyro names our class where the class itself has refused a value.
    return re.sub(r"^Error parsing \w+: ", "", " ".join(words)).rstrip(".") or "the options cannot be read"


def status_of(main: Callable[[], ExitStatus], prog: str) -> ExitStatus:
    """The status of a command's `main`; what it cannot use becomes one line on standard error.

    Args:
        main: the command.
        prog: its name, for messages.
    """
    try:
        return main()
    except GeosacsError as error:
        words = str(error)
    except OSError as error:  # a file that no reader or writer of ours has asked about
        words = f"{error.filename or 'a file'}: {error.strerror or error}"
    except MemoryError:
        words = "the memory does not suffice: give less"
    except KeyboardInterrupt:
        print(f"{prog}: stopped", file=sys.stderr)
        return ExitStatus.NOT_DONE
    except SystemExit as error:
        if not isinstance(error.code, str):
            raise
        words = error.code  # Drake's way to say that a condition of its own does not hold
    print(f"{prog}: {one_line(words)}", file=sys.stderr)
    return ExitStatus.BAD_INPUT


def end(main: Callable[[], ExitStatus], prog: str) -> NoReturn:
    """Run a command's `main` and leave with its status, whoever reads or does not read what it prints.

    Args:
        main: the command.
        prog: its name, for messages.
    """
    with unbroken_streams():
        status = status_of(main, prog)
    sys.exit(int(status))


def one_line(text: str) -> str:
    """Text from anywhere as one line of a message, no longer than `LONGEST_LINE`."""
    words = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return words if len(words) <= LONGEST_LINE else f"{words[: LONGEST_LINE - 2]} …"


LONGEST_LINE = 1000
"""Letters of a message; what a file holds may be quoted in it, and may be long."""
