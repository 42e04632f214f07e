"""A person at the console, by what they see: words, labels of buttons, and places in the picture from above.

They look, push, and look again. Where a thing is, and where the drawn way ahead ends, is read off the picture in pixels:
what the numbers of the run are nobody tells them.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from playwright.sync_api import Page

NEAR_PX = 2.5
"""[px] A miss that is left alone: 7 mm of the basket, seen from above."""
AIM_FROM = 70
"""[%] Of the way to pick, from where the person aims: the fingers are still above the things."""
AT_ONCE_PX = 150.0
"""[px] A full push is one towards something as far away."""
LOOKS = """() => {
    const { camera, renderer } = viewer, { Vector3 } = MeshCat.THREE;
    const { width, height } = renderer.domElement.getBoundingClientRect();
    const place = (path, inner) => {
        const node = path.reduce((tree, name) => tree?.children[name], viewer.scene_tree);
        if (!node) return null;
        const p = new Vector3().setFromMatrixPosition(node.object.matrixWorld).project(camera);
        return [width * (p.x + 1) / 2, height * (p.y + 1) / 2];
    };
    const drake = viewer.scene_tree.children.drake?.children;
    if (!drake?.canal?.children.ahead || !drake.visualizer) return null;
    const beads = Object.entries(drake.canal.children.ahead.children)
        .filter(([, bead]) => bead.object.visible).map(([name]) => name).sort();
    const things = drake.visualizer.children;
    const seen = {};
    for (const [name, tree] of Object.entries(things)) {
        if (!name.startsWith("item_")) continue;
        const body = Object.keys(tree.children)[0];
        seen[name.slice(5)] = place(["drake", "visualizer", name, body]);
    }
    return {
        things: seen, first: beads.length ? place(["drake", "canal", "ahead", beads[0]]) : null,
        point: place(["drake", "canal", "point"]),
    };
}"""
"""Where things, the end of the way ahead at pick, and the point on the disk are in the picture: right and up, [px]."""


class Hand(Protocol):
    """How a person presses a button of the page, and moves the stick."""

    def press(self, name: str) -> None:
        """Press the button of this name."""

    def push(self, miss: Callable[[], np.ndarray]) -> None:
        """Push the stick once towards what is missed.

        Args:
            miss: looks how far right and up it is, [px].
        """


class PadHand:
    """A mouse, or a thumb on the pad."""

    def __init__(self, page: Page) -> None:
        """Hands on `page`."""
        self._page = page

    def press(self, name: str) -> None:
        """Click it."""
        self._page.locator("main button").filter(has_text=re.compile(f"^{re.escape(name)}$")).click()

    def push(self, miss: Callable[[], np.ndarray]) -> None:
        """Drag the knob until the miss is small, slower the smaller it is."""
        mouse = self._page.mouse
        box = self._page.locator("#pad").bounding_box()
        assert box
        half = box["width"] / 2
        x, y = box["x"] + half, box["y"] + half
        mouse.move(x, y)
        mouse.down()
        end = time.monotonic() + 4.0
        while (far := float(np.linalg.norm(to_go := miss()))) > 0.6 * NEAR_PX and time.monotonic() < end:
            long = 0.62 * half * min(0.30 + far / AT_ONCE_PX, 1.0) / far
            mouse.move(x + long * to_go[0], y - long * to_go[1])
            self._page.wait_for_timeout(40)
        mouse.up()


class SwitchHand:
    """One switch: what is lit in turn is chosen by a press, a direction for as long as it is held."""

    LIT = "document.getElementById('pad').dataset.lit ?? document.querySelector('.lit')?.textContent ?? ''"
    WAYS: tuple[tuple[str, tuple[int, int]], ...] = (
        ("right", (1, 0)),
        ("left", (-1, 0)),
        ("up", (0, 1)),
        ("down", (0, -1)),
    )

    def __init__(self, page: Page) -> None:
        """A switch of `page`, which has scanning by one switch chosen."""
        self._page = page

    def _wait_for(self, name: str) -> None:
        end = time.monotonic() + 60
        while self._page.evaluate(self.LIT) != name:
            if time.monotonic() > end:
                raise TimeoutError(f"{name} is not lit")
            self._page.wait_for_timeout(30)

    def press(self, name: str) -> None:
        """Wait until it is lit, and press the switch."""
        self._wait_for(name)
        self._page.keyboard.press("Space")

    def push(self, miss: Callable[[], np.ndarray]) -> None:
        """Wait for the direction that leads nearest, and hold the switch until it leads no nearer."""
        to_go = miss()
        name, way = max(self.WAYS, key=lambda named: float(to_go @ named[1]))
        self._wait_for(name)
        self._page.keyboard.down("Space")
        end = time.monotonic() + 3.0
        while float(miss() @ way) > 0.6 * NEAR_PX and time.monotonic() < end:
            self._page.wait_for_timeout(20)
        self._page.keyboard.up("Space")


class PagePerson:
    """Somebody who loads a machine through the page."""

    def __init__(self, page: Page, hand: Hand) -> None:
        """A person at `page`, who works it by `hand`."""
        self._page, self._hand = page, hand
        self.grips = 0

    def headline(self) -> str:
        """What the page says that the robot does."""
        return self._page.locator("#headline").inner_text()

    def placed(self) -> int:
        """How many things the page says are in their place."""
        return int(self._page.locator("#f-placed").inner_text().split()[0])

    def _way(self) -> int:
        """Percent of the leg."""
        return int(self._page.locator("#track").get_attribute("aria-valuenow") or 0)

    def wait_for(self, *beginnings: str, limit_s: float = 120.0) -> str:
        """Wait until the headline begins so.

        Args:
            beginnings: what is waited for.
            limit_s: after which nothing is expected any more, [s].

        Returns:
            The headline.

        Raises:
            TimeoutError: it did not come.
        """
        end = time.monotonic() + limit_s
        while not (said := self.headline()).startswith(beginnings):
            if time.monotonic() > end:
                raise TimeoutError(f"waited for {' or '.join(beginnings)}; it says {said}")
            self._page.wait_for_timeout(30)
        return said

    def look_from_above(self) -> None:
        """Choose that view."""
        while (name := self._page.locator("#view").inner_text()) != "From above":
            self._hand.press(name)
            self._page.wait_for_timeout(300)
        self._page.wait_for_timeout(1500)

    def begin(self) -> None:
        """Press Start."""
        self.wait_for("Ready")
        self._hand.press("Start")
        self.wait_for("Going", "Waiting")

    def carry_one(self) -> bool:
        """Bring one thing from pick to place; whether the page counts one more then."""
        before = self.placed()
        self.wait_for("Going to pick", "Waiting: steer, then grip")
        while self._way() < AIM_FROM and self.headline() == "Going to pick":
            self._page.wait_for_timeout(20)
        if self.headline() == "Going to pick":
            self._hand.press("Pause")
            self._page.wait_for_timeout(600)
        self._aim()
        self.wait_for("Paused", "Waiting: steer, then grip")
        if self.headline() == "Paused":
            self._hand.press("Go on")
        self.wait_for("Waiting: steer, then grip")
        self._aim()
        self._hand.press("Grip")
        self.grips += 1
        self.wait_for("Coming back from pick", "Going to place")
        self.wait_for("Waiting: steer, then let go")
        self._hand.press("Let go")
        self.wait_for("Coming back from place", "Going to pick", "Waiting: steer, then grip")
        self.wait_for("Going to pick", "Stopped", "Ready")
        return self.placed() > before

    def _aim(self) -> None:
        """Push and look until the drawn way ends at the nearest thing."""
        for _ in range(12):
            self._page.wait_for_timeout(500)  # the picture may be half a second late
            if np.linalg.norm(self._miss()) < NEAR_PX:
                return
            self._hand.push(self._miss)

    def _miss(self) -> np.ndarray:
        """From where the way ends to the thing that is nearest to it, right and up [px]."""
        while (seen := self._page.frames[1].evaluate(LOOKS)) is None:
            print("the picture is empty", flush=True)
            self._page.wait_for_timeout(100)
        end = np.array(
            seen["first"] if self.headline() != "Waiting: steer, then grip" and seen["first"] else seen["point"]
        )
        if not hasattr(self, "_thing") or self._done != self.placed():
            self._done = self.placed()
            self._thing = min(seen["things"], key=lambda name: math.dist(seen["things"][name], end))
        return np.array(seen["things"][self._thing]) - end
