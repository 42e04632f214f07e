"""The page of a lesson without a robot behind it: each hand reaches each motion, and everything has a name."""

import json
from collections.abc import Iterator
from importlib.resources import files

import numpy as np
import pytest
from waiting import wait_until

from diagrams.teach.jog import MOVE, NOSE, SPIN
from diagrams.teach.path import Word
from geosacs_drake.console.server import ConsoleServer
from geosacs_drake.teach.answers import TeachAnswers
from geosacs_drake.teach.hand import TeachControl

pytestmark = pytest.mark.browser

STATUS = {
    "teaching": True, "time_s": 3.0, "headline": "Recording", "sentence": "2.0 s of motion.", "tone": "steer",
    "closed": False, "recording": True, "leads_back": False, "kept_s": 2.0, "way_back": True, "saved": [],
    "learned": False, "busy": False, "tool": [0.3, -0.2, 0.5], "R_BT": np.eye(3).tolist(), "rate": 1.0,
}  # fmt: skip
SIZES = {"desktop": (1280, 800), "tablet": (820, 1180), "phone": (390, 844)}


@pytest.fixture
def server() -> Iterator[ConsoleServer]:
    control = TeachControl(person_asked=True)
    server = ConsoleServer(control, TeachAnswers(control), port=0, meshcat_address=("127.0.0.1", 9), index="teach.html")
    server.start()
    yield server
    server.stop()


@pytest.fixture
def lesson(server, page, request):
    page.set_viewport_size({"width": 1280, "height": 800})
    chosen = json.dumps({"view": "seat"} | getattr(request, "param", {}))
    page.add_init_script(f"localStorage.setItem('geosacs-console', JSON.stringify({chosen}))")
    server.show(STATUS)
    page.goto(server.address)
    wait_until(lambda: page.inner_text("#headline") == "Recording", "the status", 30)
    return page


def jog(server):
    return server.control.jog_sample().jog


# From the seat in front of the robot right is y, away is -x.
@pytest.mark.parametrize(
    ("mode", "key", "part", "expected"),
    [
        ("Move", "ArrowRight", MOVE, (0, 1, 0)),
        ("Move", "ArrowUp", MOVE, (-1, 0, 0)),
        ("Move", "KeyE", MOVE, (0, 0, 1)),
        ("Move", "PageDown", MOVE, (0, 0, -1)),
        ("Turn", "ArrowLeft", NOSE, (0, -1, 0)),
        ("Turn", "ArrowDown", NOSE, (0, 0, -1)),
        ("Turn", "KeyQ", SPIN, -1),
    ],
)
def test_keys_reach_all_six_directions_and_let_go(lesson, server, mode, key, part, expected):
    lesson.get_by_role("radio", name=mode).click()
    lesson.keyboard.down(key)
    wait_until(lambda: jog(server)[part] == pytest.approx(expected, abs=0.03), key, 10)
    lesson.keyboard.up(key)
    wait_until(lambda: not jog(server).any(), "zero", 10)


def test_buttons_that_are_held_and_a_lost_window(lesson, server):
    box = lesson.get_by_role("button", name="Raise").bounding_box()
    lesson.mouse.move(box["x"] + 20, box["y"] + 20)
    lesson.mouse.down()
    wait_until(lambda: jog(server)[2] == pytest.approx(1), "raising", 10)
    lesson.mouse.up()
    wait_until(lambda: not jog(server).any(), "zero", 10)
    lesson.mouse.down()
    wait_until(lambda: jog(server)[2] == pytest.approx(1), "raising", 10)
    lesson.evaluate("window.dispatchEvent(new Event('blur'))")
    wait_until(lambda: not jog(server).any(), "zero", 10)


@pytest.mark.parametrize(
    ("press", "word"),
    [("Pause", Word.PAUSE), ("Undo", Word.UNDO), ("Back to start", Word.BACK)],
)
def test_buttons_speak_to_the_recorder(lesson, server, press, word):
    lesson.get_by_role("button", name=press, exact=True).click()
    wait_until(lambda: server.control.jog_sample().word is word, press, 10)


def test_what_cannot_be_done_now_cannot_be_pressed(lesson, server):
    assert lesson.get_by_role("button", name="Learn").is_disabled()
    assert lesson.get_by_role("button", name="Travel").is_disabled()
    saved = [{"name": f"demonstration_{k}.npz", "s": 9.0} for k in (1, 2)]
    server.show(STATUS | {"saved": saved, "kept_s": 0.0, "recording": False, "headline": "Ready to learn"})
    wait_until(lambda: lesson.get_by_role("button", name="Learn").is_enabled(), "two to learn from", 10)
    lesson.get_by_role("button", name="Learn").click()
    wait_until(lambda: server.control.requests() == ["learn"], "the request", 10)
    lesson.keyboard.press("Escape")
    lesson.get_by_role("button", name="Start", exact=True).wait_for()
    wait_until(lambda: server.control.jog_sample().word is Word.STAND, "stop", 10)
    lesson.get_by_role("button", name="Start", exact=True).click()
    wait_until(lambda: not server.control.situation().stopped, "start", 10)


@pytest.mark.parametrize("lesson", [{"scanning": "two", "mode": "step", "step_mm": 10}], indirect=True)
def test_two_switches_reach_the_lift_the_modes_and_the_recorder(lesson, server):
    def go_to(selector):
        for _ in range(40):
            if lesson.locator(f"{selector}.lit").count():
                return
            lesson.keyboard.press("Space")
        raise AssertionError(selector)

    go_to("#raise")
    lesson.keyboard.press("Enter")
    moved = []
    wait_until(lambda: moved.append(jog(server)[2]) or sum(moved) >= 2 - 1e-9, "a step of 10 mm", 10)
    assert sum(moved) * server.answers.full_stick_mm == pytest.approx(10)
    go_to("#mode-turn")
    lesson.keyboard.press("Enter")
    assert lesson.get_by_role("radio", name="Turn").get_attribute("aria-checked") == "true"
    go_to("#record")
    lesson.keyboard.press("Enter")
    wait_until(lambda: server.control.jog_sample().word is Word.PAUSE, "the recorder", 10)


@pytest.mark.parametrize("size", SIZES)
def test_everything_has_a_name_and_can_be_met(lesson, size):
    pytest.importorskip("axe_core_python", reason="needs axe-core-python")
    lesson.set_viewport_size(dict(zip(("width", "height"), SIZES[size], strict=True)))
    lesson.wait_for_timeout(500)
    lesson.evaluate(files("axe_core_python").joinpath("axe.min.js").read_text())
    found = lesson.evaluate("axe.run({exclude: [['#frame']]})")["violations"]
    assert [(v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found] == []
    small = lesson.evaluate(
        """() => [...document.querySelectorAll("button, summary, [role=application]")]
            .filter(part => part.offsetParent !== null).map(part => [part.id, part.getBoundingClientRect()])
            .filter(([, box]) => box.width < 64 || box.height < 64).map(([id]) => id)"""
    )
    assert small == []
    assert lesson.evaluate("document.documentElement.scrollWidth <= innerWidth"), "nothing lies beside the page"
