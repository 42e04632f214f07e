"""axe-core finds nothing: roles and names on everything, contrast, and targets that a shaking hand meets."""

from importlib.resources import files

import pytest
from console_status import STATUS

pytestmark = pytest.mark.browser

SMALLEST_TARGET = 64
"""[px]"""
SIZES = {"desktop": (1280, 800), "tablet": (820, 1180), "phone": (390, 844)}


def violations(page):
    pytest.importorskip("axe_core_python", reason="needs axe-core-python")
    page.evaluate(files("axe_core_python").joinpath("axe.min.js").read_text())
    found = page.evaluate("axe.run({exclude: [['#frame']]})")["violations"]
    return [(v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found]


@pytest.mark.parametrize("size", SIZES)
def test_the_page_has_no_violation(console, size):
    console.set_viewport_size(dict(zip(("width", "height"), SIZES[size], strict=True)))
    assert violations(console) == []
    small = console.evaluate(
        """least => [...document.querySelectorAll("button, summary, [role=application]")]
            .filter(part => part.offsetParent !== null)
            .map(part => [part.textContent.trim() || part.id, part.getBoundingClientRect()])
            .filter(([, box]) => box.width < least || box.height < least).map(([name]) => name)""",
        SMALLEST_TARGET,
    )
    assert small == []
    assert console.evaluate("document.documentElement.scrollWidth <= innerWidth"), "nothing lies beside the page"


@pytest.mark.parametrize("tone", ["ready", "wait", "stop"])
def test_every_tone_can_be_read(console, server, tone):
    server.show(STATUS | {"tone": tone, "headline": f"Now {tone}"})
    console.get_by_role("heading", name=f"Now {tone}").wait_for()
    console.wait_for_timeout(500)  # the colour fades in
    assert violations(console) == []


def test_the_dialogs_have_no_violation(console, server):
    console.get_by_role("button", name="Settings").click()
    assert violations(console) == []
    console.keyboard.press("Escape")
    server.show_end({"success": False, "reason": "time is up", "items": []})
    console.get_by_role("dialog", name="Ended").wait_for()
    assert violations(console) == []


def test_all_is_reached_by_tab_alone(console):
    names = set()
    for _ in range(20):
        console.keyboard.press("Tab")
        names.add(console.evaluate("document.activeElement.id"))
    assert {"pad", "start", "stop", "gripper", "reverse", "take", "settings", "view", "history"} <= names


def test_nothing_moves_by_itself_where_motion_is_not_wanted(console):
    console.emulate_media(reduced_motion="reduce")
    assert console.evaluate("getComputedStyle(document.getElementById('headline')).transitionDuration") in (
        "0s",
        "1e-05s",
    )
