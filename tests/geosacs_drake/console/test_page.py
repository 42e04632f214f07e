"""The page's hands: what a person does with keys, pad and buttons is what the robot gets."""

import math

import pytest
from console_status import STATUS
from waiting import wait_until

from canal.navigation.joystick import GRIPPER, REVERSE, START, STOP

pytestmark = pytest.mark.browser


def stick(server):
    return tuple(server.control.sample().joystick[:GRIPPER].tolist())


def held(server, expected, what="the stick"):
    wait_until(lambda: stick(server) == pytest.approx(expected, abs=0.02), what, 10)


def presses(server, button, seconds=3):
    """Samples until a press of `button` shows."""
    wait_until(lambda: server.control.sample().joystick[button] == 1, "a press", seconds)


def place(page, x, y):
    """A point of the pad: right and up, 1 at the knob's furthest."""
    box = page.locator("#pad").bounding_box()
    half = box["width"] / 2
    return box["x"] + half + 0.62 * half * x, box["y"] + half - 0.62 * half * y


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        (["ArrowRight"], (1, 0)),
        (["KeyW"], (0, 1)),
        (["ArrowLeft", "ArrowDown"], (-math.sqrt(0.5), -math.sqrt(0.5))),
        (["KeyD", "ArrowUp"], (math.sqrt(0.5), math.sqrt(0.5))),
        (["ArrowLeft", "ArrowRight"], (0, 0)),
    ],
)
def test_keys_hold_the_stick_until_they_are_released(console, server, keys, expected):
    for key in keys:
        console.keyboard.down(key)
    held(server, expected)
    console.wait_for_timeout(400)
    held(server, expected)
    for key in keys:
        console.keyboard.up(key)
    held(server, (0, 0))


def test_a_tap_moves_a_little(console, server):
    console.keyboard.press("ArrowRight")
    wait_until(lambda: stick(server) != (0, 0), "the tap", 10)
    moved = 0.2
    assert moved * server.answers.full_stick_mm <= 3
    held(server, (0, 0))


@pytest.mark.parametrize("modifier", ["Control", "Alt", "Meta"])
def test_modifiers_never_move_the_robot(console, server, modifier):
    console.keyboard.down("ArrowUp")
    held(server, (0, 1))
    console.keyboard.down(modifier)
    held(server, (0, 0))
    for key in ("ArrowRight", "KeyG"):
        console.keyboard.down(key)
        console.keyboard.up(key)
    console.wait_for_timeout(200)
    assert not server.control.sample().joystick.any()


@pytest.mark.parametrize(("key", "button"), [("Space", GRIPPER), ("r", REVERSE), ("Escape", STOP), ("Enter", START)])
def test_keys_press_buttons_once_however_long_they_are_held(console, server, key, button):
    for _ in range(5):
        console.keyboard.down(key)  # the second and later are repeats
    presses(server, button)
    console.wait_for_timeout(200)
    assert not any(server.control.sample().joystick[button] for _ in range(6))


@pytest.mark.parametrize(
    ("name", "button"), [("Grip", GRIPPER), ("Reverse", REVERSE), ("Stop", STOP), ("Pause", START)]
)
def test_buttons_press_and_give_the_keys_back(console, server, name, button):
    console.get_by_role("button", name=name, exact=True).click()
    presses(server, button)
    if button != STOP:
        console.keyboard.press("Space")
        presses(server, GRIPPER)


def test_the_pad_follows_the_mouse_and_falls_back(console, server):
    console.mouse.move(*place(console, 0, 0))
    console.mouse.down()
    console.mouse.move(*place(console, 0.9, 0.0))
    wait_until(lambda: 0.7 < stick(server)[0] < 0.95, "the push", 10)
    console.mouse.move(*place(console, 0.0, -3.0))
    held(server, (0, -1))
    console.mouse.up()
    held(server, (0, 0))


def test_the_pad_follows_a_finger(console, server):
    touch = """([x, y, type]) => document.getElementById("pad").dispatchEvent(new PointerEvent(type, {
        pointerId: 7, pointerType: "touch", clientX: x, clientY: y, bubbles: true, isPrimary: true}))"""
    console.evaluate("Element.prototype.setPointerCapture = () => {}")
    console.evaluate(touch, [*place(console, 0, 1), "pointerdown"])
    held(server, (0, 1))
    console.evaluate(touch, [*place(console, -1, 0), "pointermove"])
    held(server, (-1, 0))
    console.evaluate(touch, [*place(console, -1, 0), "pointercancel"])
    held(server, (0, 0))


def test_a_window_that_is_left_lets_go(console, server):
    console.keyboard.down("ArrowRight")
    held(server, (1, 0))
    console.evaluate("window.dispatchEvent(new Event('blur'))")
    held(server, (0, 0))
    console.wait_for_timeout(300)
    assert stick(server) == (0, 0), "a key that is still down does not come back by itself"


def test_a_page_that_is_closed_in_mid_deflection_lets_go(console, server):
    console.keyboard.down("ArrowRight")
    held(server, (1, 0))
    console.close()
    held(server, (0, 0))
    wait_until(lambda: server.control.situation().holder == "", "the page to be forgotten", 5)


def test_a_frozen_page_lets_go(console, server):
    console.keyboard.down("ArrowRight")
    held(server, (1, 0))
    console.evaluate("setTimeout(() => { const end = performance.now() + 1500; while (performance.now() < end); }, 0)")
    console.wait_for_timeout(100)
    wait_until(lambda: stick(server) == (0, 0), "the stick to fall", 1.2)


def test_one_page_steers_the_other_watches_and_may_stop(console, server, chromium):
    console.keyboard.down("ArrowRight")
    held(server, (1, 0))
    first = server.control.situation().holder
    other = chromium.new_page()
    other.goto(server.address)
    other.get_by_role("button", name="Take control").wait_for()
    other.keyboard.down("ArrowUp")
    other.wait_for_timeout(300)
    assert stick(server)[1] == 0
    other.keyboard.up("ArrowUp")
    other.get_by_role("button", name="Stop").click()
    presses(server, STOP)
    assert server.control.situation().stopped
    console.wait_for_timeout(300)
    assert stick(server) == (0, 0), "stop holds until start"
    console.keyboard.up("ArrowRight")
    other.get_by_role("button", name="Take control").click()
    wait_until(lambda: server.control.situation().holder not in ("", first), "the second page", 10)
    other.keyboard.press("Enter")
    presses(server, START)
    other.keyboard.down("ArrowUp")
    held(server, (0, 1))
    other.close()


def test_control_is_handed_back_and_taken_again(console, server):
    console.get_by_role("button", name="Watch").click()
    wait_until(lambda: server.control.situation().begun, "the beginning", 10)
    assert not server.control.situation().person
    console.get_by_role("button", name="Take control").click()
    wait_until(lambda: server.control.situation().person, "the person", 10)
    console.get_by_role("button", name="Hand back").click()
    wait_until(lambda: not server.control.situation().person, "the simulated operator", 10)


def test_keys_work_after_a_click_into_the_view(console, server):
    console.mouse.click(300, 400)
    console.wait_for_timeout(200)
    console.keyboard.down("ArrowUp")
    held(server, (0, 1))
    console.keyboard.up("ArrowUp")
    held(server, (0, 0))


def test_a_lost_link_is_said_and_comes_back(console, server):
    server.stop()
    console.get_by_role("alert").wait_for()
    assert "stick is at its centre" in console.inner_text("#link-notice")


def test_the_end_is_shown_with_its_measures(console, server):
    server.show_end(
        {
            "success": True,
            "reason": "every item is placed",
            "items": [{"name": "sock", "placed": True}],
            "task_time_s": 83.0,
            "correction_share": 0.12,
            "corrections": 14,
            "correction_distance_m": 1.2,
            "backtracks": 1,
            "max_contact_force_n": {"lio-machine": 0.0},
        }
    )
    card = console.get_by_role("dialog", name="Done")
    card.wait_for()
    for words in ("Every item is placed.", "1 of 1", "1:23 min", "12 % of it, 14 times", "none"):
        assert words in card.inner_text()


def test_keys_are_heard_in_a_view_that_was_there_before_the_page(page, server):
    """Its script may be the last to come, and by then the frame has been loaded."""
    page.set_viewport_size({"width": 1280, "height": 800})
    late = []
    page.route("**/main.js", lambda route: late.append(route))
    server.show(STATUS)
    page.goto(server.address, wait_until="commit")
    while not (late and len(page.frames) > 1 and page.frames[1].url.endswith("view/")):
        page.wait_for_timeout(20)
    page.frames[1].wait_for_load_state("load")
    late[0].continue_()
    wait_until(lambda: page.inner_text("#headline") == STATUS["headline"], "the status", 30)
    page.mouse.click(300, 400)
    page.keyboard.down("ArrowUp")
    held(server, (0, 1))
    for _ in range(3):
        page.keyboard.down("Space")
    presses(server, GRIPPER)
    page.wait_for_timeout(200)
    assert not any(server.control.sample().joystick[GRIPPER] for _ in range(6)), "heard once"
