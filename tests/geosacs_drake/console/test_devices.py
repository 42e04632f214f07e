"""Gamepads of any layout, one switch or two, a stick that stays or steps: each reaches every direction and button."""

import json

import pytest
from console_status import STATUS
from waiting import wait_until

from canal.navigation.joystick import GRIPPER, REVERSE, START, STOP
from geosacs_drake.console.bindings import BindingFiles

pytestmark = pytest.mark.browser

FAKE = """
window.pads = [];
navigator.getGamepads = () => window.pads;
window.plug = (index, id, axes, buttons, mapping = "") => {
    window.pads[index] = {index, id, mapping, connected: true, axes,
        buttons: Array.from({length: buttons}, () => ({value: 0, pressed: false, touched: false}))};
};
window.axis = (index, k, value) => { window.pads[index].axes[k] = value; };
window.push = (index, k, value) => { window.pads[index].buttons[k].value = value; };
"""
CHOOSE = """localStorage.getItem("geosacs-console") ?? localStorage.setItem("geosacs-console", JSON.stringify(%s))"""


@pytest.fixture
def faked(page):
    page.add_init_script(FAKE)
    return page


@pytest.fixture
def console(faked, request, server):
    """The page, with what a test chooses in the settings."""
    faked.set_viewport_size({"width": 1280, "height": 800})
    chosen = getattr(request, "param", {})
    faked.add_init_script(CHOOSE % json.dumps(chosen))
    server.show(STATUS)
    faked.goto(server.address)
    wait_until(lambda: faked.inner_text("#headline") == STATUS["headline"], "the status", 30)
    return faked


def stick(server):
    return tuple(server.control.sample().joystick[:GRIPPER].tolist())


def held(server, expected, what="the stick"):
    wait_until(lambda: stick(server) == pytest.approx(expected, abs=0.03), what, 10)


def pressed(server, button):
    wait_until(lambda: server.control.sample().joystick[button] == 1, f"button {button}", 10)


def test_two_gamepads_one_idle_in_any_order(console, server):
    console.evaluate("plug(0, 'Idle pad', [0.05, -0.03, 0, 0], 17, 'standard')")
    console.evaluate("plug(1, 'Busy pad', [0.08, 0.02, 0, 0], 17, 'standard')")
    console.get_by_text("Idle pad").wait_for()
    console.get_by_text("Busy pad").wait_for()
    console.evaluate("axis(1, 0, 1)")
    held(server, (1, 0))
    console.evaluate("axis(1, 0, 0.08); axis(1, 1, -1)")
    held(server, (0, 1))
    console.evaluate("axis(1, 1, 0.02)")
    held(server, (0, 0))
    console.evaluate("axis(0, 0, -1)")
    held(server, (-1, 0))
    console.evaluate("axis(0, 0, 0.05); push(1, 0, 1)")
    pressed(server, GRIPPER)
    console.evaluate("push(1, 0, 0); push(0, 8, 1)")
    pressed(server, STOP)


def test_a_gamepad_that_is_unplugged_lets_go(console, server):
    console.evaluate("plug(0, 'Pad', [0, 0], 17, 'standard')")
    console.get_by_role("button", name="Set up Pad").wait_for()
    console.evaluate("axis(0, 0, 1)")
    held(server, (1, 0))
    console.evaluate("window.pads = []")
    held(server, (0, 0))


def test_a_stick_that_rests_beside_its_centre_moves_nothing(console, server):
    console.evaluate("plug(0, 'Worn', [0.3, -0.2, 0, 0], 12, 'standard')")
    console.get_by_text("Worn").wait_for()
    console.wait_for_timeout(300)
    assert stick(server) == (0, 0)
    console.evaluate("axis(0, 0, 1)")
    held(server, (1, 0))


def test_controls_are_bound_by_moving_them_saved_by_name_and_loaded_again(console, server):
    console.evaluate("plug(0, 'Adaptive (Vendor: 1 Product: 2)', [0, 0, 0, -1], 6)")
    console.get_by_role("button", name="Set up Adaptive").click()
    dialog = console.get_by_role("dialog", name="Set up Adaptive")
    moves = [(2, 1), (2, -1), (1, 1), (1, -1)]
    for k, (axis, value) in enumerate(moves):
        dialog.get_by_text(f"{k + 1} of 8").wait_for()
        console.wait_for_timeout(60)
        console.evaluate(f"axis(0, {axis}, {value})")
        dialog.get_by_text(f"{k + 2} of 8").wait_for()
        console.evaluate(f"axis(0, {axis}, 0)")
    for k, button in enumerate((3, 4, 5)):
        dialog.get_by_text(f"{k + 5} of 8").wait_for()
        console.wait_for_timeout(60)
        console.evaluate(f"push(0, {button}, 1)")
        dialog.get_by_text(f"{k + 6} of 8").wait_for()
        console.evaluate(f"push(0, {button}, 0)")
    dialog.get_by_role("button", name="Leave out").click()
    dialog.get_by_label("Keep it under the name").fill("my lap tray")
    dialog.get_by_role("button", name="Save").click()
    folder = server.answers.bindings.folder
    wait_until(lambda: (folder / "my lap tray.json").exists(), "the file", 10)
    assert not server.control.sample().joystick.any(), "binding moves nothing"
    kept = BindingFiles(folder).all()["my lap tray"]
    assert kept["right"] == {"axis": 2, "sign": 1}
    assert kept["down"] == {"axis": 1, "sign": -1}
    assert kept["gripper"] == {"button": 3}
    assert "stop" not in kept
    server.about = {"bindings": BindingFiles(folder).all()}
    console.reload()
    console.get_by_text("Going to pick").wait_for()
    console.evaluate("plug(0, 'Adaptive (Vendor: 1 Product: 2)', [0, 0, 0, -1], 6)")
    console.get_by_role("button", name="Set up Adaptive").wait_for()
    console.evaluate("axis(0, 2, 1)")
    held(server, (1, 0))
    console.evaluate("axis(0, 2, 0); push(0, 4, 1)")
    pressed(server, REVERSE)


@pytest.mark.parametrize("console", [{"mode": "latch"}], indirect=True)
def test_latched_it_moves_until_pressed_again(console, server):
    console.keyboard.press("ArrowRight")
    held(server, (1, 0))
    console.wait_for_timeout(500)
    held(server, (1, 0))
    console.keyboard.press("ArrowRight")
    held(server, (0, 0))
    console.keyboard.press("ArrowUp")
    held(server, (0, 1))
    console.keyboard.press("Escape")
    held(server, (0, 0))


@pytest.mark.parametrize("console", [{"mode": "step", "step_mm": 2}], indirect=True)
def test_a_step_moves_as_many_millimetres_as_were_chosen(console, server):
    console.keyboard.press("ArrowUp")
    moved = []
    wait_until(lambda: moved.append(stick(server)) or moved[-1] != (0, 0), "the step", 10)
    moved += [stick(server) for _ in range(5)]
    assert sum(y for _, y in moved) * server.answers.full_stick_mm == pytest.approx(2)
    assert all(x == 0 for x, _ in moved)


def lit(page):
    return page.evaluate(
        "document.getElementById('pad').dataset.lit ?? document.querySelector('.lit')?.textContent ?? ''"
    )


@pytest.mark.parametrize("console", [{"scanning": "two"}], indirect=True)
def test_two_switches_reach_every_direction_and_button(console, server):
    """One goes on, the other chooses; nothing is timed."""
    seen = {}

    def choose(name):
        for _ in range(20):
            if lit(console) == name:
                return
            console.keyboard.press("Space")
        pytest.fail(f"{name} is never lit")

    for name, expected in {"up": (0, 1), "right": (1, 0), "left": (-1, 0), "down": (0, -1)}.items():
        choose(name)
        console.keyboard.down("Enter")
        held(server, expected, name)
        console.keyboard.up("Enter")
        held(server, (0, 0), name)
        seen[name] = True
    for name, button in {"Grip": GRIPPER, "Reverse": REVERSE, "Pause": START}.items():
        choose(name)
        console.keyboard.press("Enter")
        pressed(server, button)
    choose("Settings")
    console.keyboard.press("Enter")
    console.get_by_role("dialog", name="Settings").wait_for()
    choose("Done")
    console.keyboard.press("Enter")
    wait_until(lambda: not console.get_by_role("dialog").is_visible(), "the dialog to close", 10)
    choose("Stop")
    console.keyboard.press("Enter")
    pressed(server, STOP)


@pytest.mark.parametrize("console", [{"scanning": "one", "dwell_s": 2.5}], indirect=True)
def test_one_switch_chooses_what_is_lit(console, server):
    wait_until(lambda: lit(console) == "left", "left to be lit", 30)
    console.keyboard.down("Space")
    held(server, (-1, 0))
    console.wait_for_timeout(3000)
    assert lit(console) == "left", "while the switch is held nothing else is lit"
    held(server, (-1, 0))
    console.keyboard.up("Space")
    held(server, (0, 0))
    wait_until(lambda: lit(console) == "Stop", "stop to be lit", 60)
    console.mouse.click(1200, 400)  # anywhere
    pressed(server, STOP)


def test_settings_are_kept(console, server):
    console.get_by_role("button", name="Settings").click()
    console.get_by_role("radio", name="in steps").click()
    console.get_by_role("radio", name="as I sit").click()
    console.get_by_role("radio", name="at its left").click()
    console.get_by_role("button", name="Done").click()
    console.evaluate("document.activeElement.blur()")
    assert json.loads(console.evaluate("localStorage.getItem('geosacs-console')"))["mode"] == "step"
    console.keyboard.press("ArrowRight")
    wait_until(lambda: stick(server)[0] > 0, "a step", 10)
