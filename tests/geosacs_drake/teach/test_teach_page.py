"""A demonstration pair taught through the page, learned, and travelled."""

from collections.abc import Callable

import numpy as np
import pytest
from running import running
from waiting import wait_until

from canal.demonstration import load_demonstration
from canal.surface_file import load_canal

pytestmark = pytest.mark.browser

RATE = 3.0
"""Simulated over real time: three times as fast as a person would have it."""


class Hands:
    """What a person does at the page, who looks at where the gripper is."""

    def __init__(self, page):
        self.page = page

    def at(self) -> list[float]:
        """Where the page says that the gripper is [m]."""
        return [
            float(v) / 100 for v in self.page.inner_text("#f-place").removeprefix("at ").removesuffix(" cm").split(", ")
        ]

    def headline(self) -> str:
        return self.page.inner_text("#headline")

    def until(self, key: str, there: Callable[[list[float]], bool]) -> None:
        """Hold a key until the gripper is there, or the arm reaches no further."""
        self.page.keyboard.down(key)
        wait_until(lambda: there(self.at()) or "no further" in self.headline(), f"{key}, {self.at()}", 90)
        self.page.keyboard.up(key)

    def press(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).click()


def test_a_pair_is_taught_through_the_page_learned_and_travelled(page, tmp_path):
    options = ("--output", str(tmp_path), "--port", "0", "--realtime-rate", str(RATE))
    with running("geosacs_drake.run_teach", *options) as command:
        page.set_viewport_size({"width": 1280, "height": 800})
        page.goto(command.address())
        hands = Hands(page)
        wait_until(lambda: hands.headline() == "Move to where it begins", "the lesson", 90)
        page.get_by_role("button", name="View: from the room").click()  # the next one is from the seat, in front
        page.get_by_role("button", name="View: from the seat").wait_for()
        page.wait_for_timeout(1500)
        hands.until("ArrowLeft", lambda at: at[1] < -0.40)
        hands.until("ArrowUp", lambda at: at[0] < 0.27)
        page.get_by_role("radio", name="Turn").click()
        page.keyboard.down("ArrowDown")
        page.wait_for_timeout(4000 / RATE)
        page.keyboard.up("ArrowDown")
        page.get_by_role("radio", name="Move").click()
        hands.until("KeyQ", lambda at: at[2] < 0.50)
        for place, aside in ((1, 0.0), (2, 0.07)):
            hands.press("Record")
            wait_until(lambda: hands.headline() == "Recording", "the recording", 30)
            hands.until("KeyE", lambda at: at[2] > 0.60)
            hands.until("ArrowRight", lambda at: at[1] > 0.40)
            hands.until("KeyQ", lambda at: at[2] < 0.50)
            hands.press("Save")
            wait_until(
                lambda place=place: page.locator("#saved li").count() == place and hands.headline() != "Recording",
                "the file",
                30,
            )
            if aside == 0.0:
                hands.press("Back to start")
                wait_until(lambda: hands.headline() == "Going back", "the way back", 30)
                wait_until(lambda: hands.headline() == "One more", "the start", 120)
                hands.until("ArrowDown", lambda at: at[0] > 0.33)
        hands.press("Learn")
        wait_until(lambda: hands.headline() == "The canal is learned", "the canal", 90)
        scene = page.frames[1]
        wait_until(
            lambda: scene.evaluate("Boolean(viewer.scene_tree.find(['drake', 'canal']).children.surface)"),
            "the canal to be drawn",
            30,
        )
        first, second = (load_demonstration(tmp_path / f"demonstration_{k}.npz") for k in (1, 2))
        assert np.linalg.norm(first.position[-1] - first.position[0]) > 0.7
        assert abs(second.position[0, 0] - first.position[0, 0]) > 0.03
        canal = load_canal(tmp_path / "canal_1.npz")
        hands.press("Travel")
        wait_until(lambda: hands.headline() == "Ready", "the run", 180)
        page.get_by_role("button", name="Watch").click()
        wait_until(lambda: hands.headline() == "Going to pick", "the travel", 60)
        begin = page.get_by_role("progressbar").get_attribute("aria-valuenow")
        wait_until(lambda: page.get_by_role("progressbar").get_attribute("aria-valuenow") != begin, "progress", 60)
        assert 0.8 < canal.length < 2.0
