"""Running once more: the same command in the same process and at the same address, so that open pages find it."""

from __future__ import annotations

import os
import sys
from typing import NoReturn

_ADDRESS = "GEOSACS_CONSOLE"


def run_again(port: int, token: str) -> NoReturn:
    """Begin the command anew; the pages of `port` with `token` stay and connect again.

    Args:
        port: of the console, which the new run takes over.
        token: of its address.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os.environ[_ADDRESS] = f"{port} {token}"
    os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])


def earlier_address() -> tuple[int, str] | None:
    """Port and token of the run that this one follows; None where it is the first."""
    port, _, token = os.environ.pop(_ADDRESS, "").partition(" ")
    return (int(port), token) if port.isdecimal() and token else None
