"""How a run is ended from outside: the first Ctrl-C asks, the second ends it at once, whatever it is doing.

Python runs a signal's handler only between two of its own steps, so one that asks is not heard inside a call of Drake's
that hangs. Beside the run waits a process that hears every signal (`signal.set_wakeup_fd` works from C), and kills the
run when it was told twice and is still there.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from enum import Enum
from types import FrameType
from typing import NoReturn

from canal.files import discard_unfinished

SAME_PRESS_S = 0.3
"""[s] Signals closer than this are one: GNU timeout sends its own twice, to the process and to its group."""
GRACE_S = 1.0
"""[s] How long the run has to end by itself after the second signal."""

_NEW_PHASE = b"\0"
_WATCH = f"""
import os, select, signal, sys, time
first = None
while byte := os.read(0, 1):
    now = time.monotonic()
    if byte == {_NEW_PHASE!r}:
        first = None
    elif first is None:
        first = now
    elif now - first > {SAME_PRESS_S}:
        if select.select([0], [], [], {GRACE_S})[0] and os.read(0, 1) in (b"", {_NEW_PHASE!r}):
            first = None
        elif os.getppid() == int(sys.argv[1]):
            os.kill(int(sys.argv[1]), signal.SIGKILL)
"""
"""The process beside the run. It reads a byte a signal, and ends when the run's end of the pipe closes."""


class Phase(Enum):
    """What a signal means."""

    BUILDING = "nothing is measured yet: the first signal is a KeyboardInterrupt"
    """Nothing has been simulated yet."""
    RUNNING = "the first signal asks the run to end, and to write what it has"
    """The simulation advances."""
    WRITING = "the first signal changes nothing but says so, since files are being written"
    """The outputs are being written."""


class Interrupts:
    """While it lasts, Ctrl-C, a polite kill and a hang-up are requests, the second an order.

    In a thread other than the main one it changes nothing: signals are the main thread's.
    """

    def __init__(self) -> None:
        self._phase = Phase.BUILDING
        self._asked = False
        self._last = -SAME_PRESS_S
        self._cleanup = contextlib.ExitStack()
        self._pipe: int | None = None

    @property
    def asked(self) -> bool:
        """Whether the run was asked to end."""
        return self._asked

    def begin(self, phase: Phase) -> None:
        """What a signal means from now on; counts anew."""
        self._told = 0
        self._phase = phase
        if self._pipe is not None:
            os.write(self._pipe, _NEW_PHASE)

    def __enter__(self) -> Interrupts:
        self._told = 0
        if threading.current_thread() is not threading.main_thread():
            return self
        self._watch()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            before = signal.getsignal(number)
            if number == signal.SIGHUP and before == signal.SIG_IGN:  # nohup
                continue
            signal.signal(number, self._handle)
            self._cleanup.callback(signal.signal, number, before)
        return self

    def __exit__(self, *_: object) -> None:
        self._cleanup.close()

    def _watch(self) -> None:
        read, write = os.pipe()
        os.set_blocking(write, False)
        try:
            beside = subprocess.Popen(
                [sys.executable, "-I", "-S", "-c", _WATCH, str(os.getpid())],
                stdin=read,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,  # what the terminal sends to the run's group is not for it
            )
        except OSError:  # no more processes: the handlers do what they can
            os.close(write)
            return
        finally:
            os.close(read)
        self._pipe = write
        before = signal.set_wakeup_fd(write, warn_on_full_buffer=False)
        self._cleanup.callback(beside.wait)
        self._cleanup.callback(beside.kill)
        self._cleanup.callback(os.close, write)
        self._cleanup.callback(setattr, self, "_pipe", None)
        self._cleanup.callback(signal.set_wakeup_fd, before)

    def _handle(self, number: int, _: FrameType | None) -> None:
        now = time.monotonic()
        if now - self._last < SAME_PRESS_S:
            return
        self._last = now
        self._told += 1
        if self._told > 1:
            _end_at_once(number)
        if self._phase is Phase.BUILDING:
            raise KeyboardInterrupt
        self._asked = True
        doing = "ends, and writes its files" if self._phase is Phase.RUNNING else "is writing its files"
        _say(f"the run {doing}; once more ends it at once")


def _end_at_once(number: int) -> NoReturn:
    discard_unfinished()
    os._exit(128 + number)  # as the shell says it


def _say(line: str) -> None:
    # A handler may interrupt a print: past Python's buffers, which are not re-entrant.
    with contextlib.suppress(OSError):
        os.write(2, f"\n{line}\n".encode())
