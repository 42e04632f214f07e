"""Running once more, or another command: in the same process and at the same address, so that open pages find it."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import NoReturn

_ADDRESS = "GEOSACS_CONSOLE"


def run_again(port: int, token: str) -> NoReturn:
    """Begin the command anew; the pages of `port` with `token` stay and connect again.

    Args:
        port: of the console, which the new run takes over.
        token: of its address.
    """
    run_instead(sys.orig_argv[1:], (port, token))


def run_instead(arguments: Sequence[str], address: tuple[int, str] | None = None) -> NoReturn:
    """Become another command of this project.

    Args:
        arguments: of the Python interpreter.
        address: port and token of the console whose pages stay and connect to the new one; None: there is none.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    if address is not None:
        os.environ[_ADDRESS] = f"{address[0]} {address[1]}"
    os.execv(sys.executable, [sys.executable, *arguments])


def earlier_address() -> tuple[int, str] | None:
    """Port and token of the run that this one follows; None where it is the first."""
    port, _, token = os.environ.pop(_ADDRESS, "").partition(" ")
    return (int(port), token) if port.isdecimal() and token else None
