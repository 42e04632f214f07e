"""A page that is out of sight, frozen, stopped or gone holds no stick.

How long it takes is measured by `make bench-console`. Here it is asserted of the link's own times: no sample shows a
stick that nobody has confirmed for longer than the law says.
"""

import asyncio
import shutil
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import pytest
from console_status import STATUS

from benchmarks.console.own_browser import OwnBrowser, own_browser
from canal.navigation.joystick import GRIPPER
from geosacs_drake.console.control import STALE_S

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(shutil.which("chromium") is None, reason="needs Chromium"),
]


class Witness:
    """The link's clock, which notes when it confirmed a stick; and which samples show one."""

    def __init__(self, control) -> None:
        self._control = control
        self.confirmed = float("-inf")
        self.held_at = float("-inf")
        self.late: list[float] = []
        control.clock = self

    def __call__(self) -> float:
        now = time.monotonic()
        if threading.current_thread().name == "console":  # the server's own
            self.confirmed = now
        return now

    def held(self) -> bool:
        """Whether a sample shows the stick off its centre; one that nobody has confirmed is noted."""
        asked = time.monotonic()
        held = bool(self._control.sample().joystick[:GRIPPER].any())
        if held and asked - self.confirmed > STALE_S:
            self.late.append(asked - self.confirmed)
        if held:
            self.held_at = time.monotonic()
        return held

    def rests(self) -> bool:
        """Whether no sample has shown it for half a second; what was under way at first may still have come."""
        return not self.held() and time.monotonic() - self.held_at > 0.5


async def until(condition: Callable[[], bool], what: str, limit_s: float = 60.0) -> None:
    end = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < end, f"waited {limit_s} s for {what}"
        await asyncio.sleep(0.005)


async def shows_the_run(browser: OwnBrowser) -> None:
    end = time.monotonic() + 60
    while await browser.evaluate("document.getElementById('headline')?.textContent") != STATUS["headline"]:
        assert time.monotonic() < end
        await asyncio.sleep(0.05)


@pytest.mark.parametrize("becomes", ["hide", "freeze", "stop", "close_tab", "kill"])
def test_what_it_held_falls_to_its_centre_and_stays_there(server, becomes):
    witness = Witness(server.control)
    server.show(STATUS)

    async def watch() -> None:
        async with own_browser() as browser:
            await browser.open(server.address)
            await shows_the_run(browser)
            await browser.hold_right()
            await until(witness.held, "the stick to be held")
            await getattr(browser, becomes)()
            await until(witness.rests, "the stick to fall, and to stay")
            if becomes in ("close_tab", "kill"):
                await until(lambda: server.control.situation().holder == "", "the page to be forgotten")
            if becomes == "stop":
                await asyncio.sleep(3.5)
                await browser.go_on()
                await browser.evaluate("new Promise(done => setTimeout(done, 300))")
                assert not witness.held(), "nobody knows what became of the key meanwhile"
                await browser.let_go()
                await browser.hold_right()
                await until(witness.held, "another push")

    with ThreadPoolExecutor(1) as other:  # Playwright's loop may run in this thread
        other.submit(asyncio.run, watch()).result()
    assert witness.late == []
