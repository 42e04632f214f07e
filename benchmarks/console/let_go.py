"""How long a stick is held by a page that is out of sight, frozen, stopped, or gone: sampled as a run samples it.

The arrow key is down all the while. Times are from before the browser is told to do it, or ended.
"""

from __future__ import annotations

import asyncio
import threading
import time
from typing import Any

import numpy as np

from benchmarks.console.own_browser import OwnBrowser, own_browser
from canal.navigation.joystick import GRIPPER, JOYSTICK_PERIOD
from geosacs_drake.console.control import Control
from geosacs_drake.console.server import ConsoleServer

WAYS = {
    "hide": "page hidden",
    "freeze": "page frozen",
    "stop": "browser stopped",
    "close_tab": "tab closed",
    "kill": "browser killed",
}
"""What becomes of the page: methods of `OwnBrowser`, and the words for them."""
QUIET_S = 0.6
"""[s] Without a push, after which none comes any more."""


class _Sampler:
    """Samples the stick at the run's rate; notes when it was off its centre last."""

    def __init__(self, control: Control) -> None:
        self._control = control
        self._end = threading.Event()
        self.pushed = float("-inf")
        self.rests = float("-inf")
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not self._end.wait(JOYSTICK_PERIOD):
            now = time.monotonic()
            if self._control.sample().joystick[:GRIPPER].any():
                self.pushed = now
            elif self.pushed > self.rests:
                self.rests = now

    def close(self) -> None:
        self._end.set()


async def _push(browser: OwnBrowser, address: str, sampler: _Sampler) -> None:
    await browser.open(address)
    while await browser.evaluate("document.readyState") != "complete":
        await asyncio.sleep(0.05)
    await asyncio.sleep(1.0)
    await browser.hold_right()
    begin = time.monotonic()
    while sampler.pushed < begin:
        await asyncio.sleep(0.01)
    await asyncio.sleep(0.6)


async def let_go(way: str, repeats: int) -> np.ndarray:
    """How long it takes until the stick is at its centre and stays there [ms].

    Args:
        way: one of `WAYS`.
        repeats: how often it is tried, each time with a browser of its own.
    """
    taken = []
    for _ in range(repeats):
        server = ConsoleServer(Control(), port=0, meshcat_address=("127.0.0.1", 9))
        server.start()
        sampler = _Sampler(server.control)
        try:
            async with own_browser() as browser:
                await _push(browser, server.address, sampler)
                begin = time.monotonic()
                action: Any = getattr(browser, way)()
                await action
                while time.monotonic() - max(sampler.pushed, begin) < QUIET_S:
                    await asyncio.sleep(0.01)
                taken.append(1000 * max(sampler.rests - begin, 0.0))
        finally:
            sampler.close()
            server.stop()
    return np.array(taken)


def all_ways(repeats: int) -> dict[str, np.ndarray]:
    """The times of each way [ms].

    Args:
        repeats: how often each is tried.
    """
    return {words: asyncio.run(let_go(way, repeats)) for way, words in WAYS.items()}
