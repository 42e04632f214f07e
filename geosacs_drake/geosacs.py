"""`geosacs COMMAND ...`: the commands of this project, from any folder."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

from canal.errors import InputError
from geosacs_drake.process.command_line import ExitStatus, end

PROG = "geosacs"
"""Name of the command."""


def _run(task: str) -> Callable[[list[str], str], NoReturn]:
    def start(arguments: list[str], prog: str) -> NoReturn:
        from geosacs_drake.run import main

        main(task, arguments, prog)

    return start


def _learn(arguments: list[str], prog: str) -> NoReturn:
    from geosacs_drake.learn import command

    command(arguments, prog)


def _teach(arguments: list[str], prog: str) -> NoReturn:
    from geosacs_drake.teach.run import main

    main(arguments, prog)


# Each imports what it needs: Drake takes two seconds.
COMMANDS: dict[str, tuple[str, Callable[[list[str], str], NoReturn]]] = {
    "run-laundry": ("load a washing machine", _run("laundry")),
    "run-relocation": ("move an apple, a cup and a cube from table to table", _run("relocation")),
    "run-teach": ("record demonstrations in the simulation, learn the canal, travel it", _teach),
    "learn": ("demonstrations in, a canal out", _learn),
}
"""By name: what it does, and how it starts. `run laundry` is `run-laundry`, and so is `laundry`."""


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Start the command that the first words name; the others are its options."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words[:1] == ["run"] and "-".join(words[:2]) in COMMANDS:
        words = [f"run-{words[1]}", *words[2:]]
    name = words[0].replace("_", "-") if words else ""
    if f"run-{name}" in COMMANDS:
        name = f"run-{name}"
    if name in COMMANDS:
        COMMANDS[name][1](words[1:], f"{PROG} {name}")
    end(lambda: _help(words), PROG)


def _help(words: Sequence[str]) -> ExitStatus:
    if words and words[0] not in ("-h", "--help"):
        raise InputError(f"there is no command {words[0]!r}; use {', '.join(COMMANDS)}")
    lines = [f"  {name:16}{what}" for name, (what, _) in COMMANDS.items()]
    print("\n".join([f"usage: {PROG} COMMAND [OPTIONS]", "", *lines, "", f"{PROG} COMMAND --help says its options."]))
    return ExitStatus.DONE if words else ExitStatus.BAD_INPUT


if __name__ == "__main__":
    main()
