"""A command of the project running beside a test, with its page in a browser."""

from __future__ import annotations

import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from waiting import wait_until


class RunningCommand:
    """A process and what it has printed so far."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.lines: list[str] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        self.lines.extend(iter(self.process.stdout.readline, ""))

    @property
    def output(self) -> str:
        """What it has printed."""
        return "".join(self.lines)

    def address(self) -> str:
        """The page's address, once it has printed it."""
        wait_until(lambda: self._address() is not None or self.process.poll() is not None, "the address", 120)
        address = self._address()
        assert address is not None, self.output
        return address

    def _address(self) -> str | None:
        found = re.search(r"at (http://localhost:\d+(?:/[\w-]+/)?)", self.output)
        return found and found.group(1)


@contextmanager
def running(module: str, *arguments: str) -> Iterator[RunningCommand]:
    """Run `python -m module arguments` until the block ends."""
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", module, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        yield RunningCommand(process)
    finally:
        process.kill()
        process.wait()
