"""A person's joystick: a gamepad's numbers, and real keys, clicks and gamepads in a real page."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from waiting import wait_until

from canal.navigation.joystick import GRIPPER, K_X, K_Y, REVERSE, START, STOP
from diagrams.teleop.meshcat_joystick import CENTRE, CONTROLS, KEYS, SLIDERS, MeshcatJoystick, read_gamepad

NUMBERS = st.floats(allow_nan=True, allow_infinity=True)


@given(st.lists(NUMBERS, max_size=6), st.lists(NUMBERS, max_size=20), st.floats(0, 0.9))
def test_whatever_a_gamepad_says_the_joystick_is_within_bounds(axes, buttons, dead_zone):
    joystick = read_gamepad(axes, buttons, dead_zone)
    assert np.isfinite(joystick).all()
    assert np.hypot(*joystick[:2]) <= 1 + 1e-9
    assert set(joystick[GRIPPER:]) <= {0.0, 1.0}


def test_up_on_a_gamepad_is_along_y():
    np.testing.assert_allclose(read_gamepad([0, -1, 0, 0], [], 0.1)[:2], [0, 1])


def test_the_dead_zone_is_round_and_starts_from_zero():
    assert not read_gamepad([0.1, 0.1], [], 0.15).any()
    assert np.hypot(*read_gamepad([0.1501, 0.0], [], 0.15)[:2]) < 2e-3
    np.testing.assert_allclose(read_gamepad([0.575, 0], [], 0.15)[:2], [0.5, 0])
    np.testing.assert_allclose(read_gamepad([1, 0], [], 0.15)[:2], [1, 0])


def test_the_buttons_of_a_standard_gamepad():
    for button, index in ((0, GRIPPER), (1, REVERSE), (9, START), (8, STOP)):
        values = np.zeros(17)
        values[button] = 1
        np.testing.assert_array_equal(np.flatnonzero(read_gamepad([0, 0], values, 0.1)), [index])


def test_every_control_is_written_down():
    for key in KEYS:
        assert "[" in key.label
    for word in ("arrow", "G", "R", "Enter", "Space", "gamepad"):
        assert word in CONTROLS


class Running:
    """A joystick in a running simulation, that a test advances sample by sample."""

    def __init__(self, meshcat):
        builder = DiagramBuilder()
        self.system = MeshcatJoystick.AddToBuilder(builder=builder, meshcat=meshcat)
        self.simulator = Simulator(builder.Build())
        self.simulator.Initialize()
        self.meshcat = meshcat

    def advance(self, seconds):
        self.simulator.AdvanceTo(self.simulator.get_context().get_time() + seconds)

    @property
    def joystick(self):
        context = self.system.GetMyContextFromRoot(self.simulator.get_context())
        return self.system.GetOutputPort("joystick").Eval(context).copy()

    def becomes(self, wanted):
        """Sample until the joystick is `wanted`; simulated time stands still while the browser's news arrives."""

        def sampled():
            self.advance(0.05)
            return np.allclose(self.joystick, wanted, atol=1e-6)

        wait_until(sampled, f"the joystick {wanted}; it is {self.joystick}")


def vector(values):
    """A joystick vector from index → value."""
    joystick = np.zeros(6)
    for index, value in values.items():
        joystick[index] = value
    return joystick


def test_without_a_page_everything_rests(meshcat):
    running = Running(meshcat)
    meshcat.SetSliderValue(SLIDERS[0], 0.5)
    running.advance(0.2)
    assert not running.joystick.any()
    assert meshcat.GetSliderValue(SLIDERS[0]) == 0


def test_building_twice_on_one_page_is_allowed(meshcat):
    MeshcatJoystick(meshcat)
    MeshcatJoystick(meshcat)
    assert [name for name in meshcat.GetSliderNames() if name in SLIDERS] == list(SLIDERS)


KEYBOARD = (
    ("ArrowRight", vector({K_X: 1})),
    ("ArrowLeft", vector({K_X: -1})),
    ("ArrowUp", vector({K_Y: 1})),
    ("ArrowDown", vector({K_Y: -1})),
    ("g", vector({GRIPPER: 1})),
    ("r", vector({REVERSE: 1})),
    ("Enter", vector({START: 1})),
    (" ", vector({STOP: 1})),
)


@pytest.mark.browser
def test_a_key_pressed_in_the_page_moves_the_joystick_and_ends(meshcat_page):
    meshcat, page = meshcat_page
    running = Running(meshcat)
    for key, wanted in KEYBOARD:
        press(meshcat, page, key)
        running.becomes(wanted)
        running.advance(0.8)
        assert not running.joystick.any()


def press(meshcat, page, key):
    """Press a key and wait until Drake knows."""
    before = clicks(meshcat)
    wait_until(lambda: page.evaluate("Object.keys(viewer.keydown_callbacks).length") > len(KEYS), "the controls")
    page.keyboard.press(key)
    wait_until(lambda: clicks(meshcat) > before, f"the key {key!r}")


def clicks(meshcat):
    return sum(meshcat.GetButtonClicks(name) for name in meshcat.GetButtonNames())


@pytest.mark.browser
def test_a_nudge_lasts_a_quarter_second_and_repeats_extend_it(meshcat_page):
    meshcat, page = meshcat_page
    running = Running(meshcat)
    press(meshcat, page, "ArrowUp")
    running.advance(0.2)
    assert running.joystick[K_Y] == 1
    press(meshcat, page, "ArrowUp")
    running.advance(0.2)
    assert running.joystick[K_Y] == 1
    running.advance(0.15)
    assert running.joystick[K_Y] == 0


@pytest.mark.browser
def test_two_arrows_make_a_diagonal_of_length_one(meshcat_page):
    meshcat, page = meshcat_page
    running = Running(meshcat)
    press(meshcat, page, "ArrowUp")
    press(meshcat, page, "ArrowLeft")
    running.advance(0.1)
    np.testing.assert_allclose(running.joystick, vector({K_X: -np.sqrt(0.5), K_Y: np.sqrt(0.5)}))


@pytest.mark.browser
def test_a_key_held_down_is_one_press_of_its_button(meshcat_page):
    meshcat, page = meshcat_page
    running = Running(meshcat)
    levels = []
    for _ in range(3):  # a keyboard's delay before it repeats is 0.25 to 0.66 s
        press(meshcat, page, "g")
        for _ in range(10):
            running.advance(0.05)
            levels.append(running.joystick[GRIPPER])
    assert levels == [1.0] * 30


@pytest.mark.browser
def test_what_was_pressed_before_the_run_is_no_command(meshcat_page):
    meshcat, page = meshcat_page
    MeshcatJoystick(meshcat)
    press(meshcat, page, "Enter")
    system = MeshcatJoystick(meshcat)
    press(meshcat, page, "Enter")
    simulator = Simulator(system)
    simulator.AdvanceTo(0.2)
    assert not system.GetOutputPort("joystick").Eval(simulator.get_context()).any()


@pytest.mark.browser
def test_buttons_and_sliders_on_the_screen(meshcat_page):
    meshcat, page = meshcat_page
    running = Running(meshcat)
    page.get_by_text("Open Controls").click()
    page.get_by_text(KEYS[4].label).click()
    running.becomes(vector({GRIPPER: 1}))
    running.advance(0.8)
    slider = page.locator(".dg li.has-slider", has_text=SLIDERS[1]).locator(".slider")
    box = slider.bounding_box()
    slider.click(position={"x": box["width"] * 0.75, "y": box["height"] / 2})
    wait_until(lambda: meshcat.GetSliderValue(SLIDERS[1]) != 0, "the slider")
    running.advance(2.0)
    np.testing.assert_allclose(running.joystick, vector({K_Y: 0.5}), atol=0.06)
    page.get_by_text(CENTRE[0]).click()
    running.becomes(np.zeros(6))


GAMEPAD = """
window.pad = {index: 0, connected: true, axes: [0, 0, 0, 0], buttons: Array(17).fill({value: 0})};
navigator.getGamepads = () => [window.pad];
"""


@pytest.fixture
def pad_page(meshcat, page):
    """A page with a gamepad, connected to `meshcat`."""
    page.add_init_script(GAMEPAD)
    page.goto(meshcat.web_url())
    wait_until(lambda: meshcat.GetGamepad().index == 0, "the gamepad")
    yield page
    if not page.is_closed():
        page.close()
    wait_until(lambda: meshcat.GetNumActiveConnections() == 0, "the page to leave")


@pytest.mark.browser
def test_a_gamepad_in_the_page_moves_the_joystick(meshcat, pad_page):
    running = Running(meshcat)
    pad_page.evaluate("pad.axes = [0.6, -0.8, 1, 1]")
    running.becomes(vector({K_X: 0.6, K_Y: 0.8}))
    pad_page.evaluate("pad.axes = [0.05, -0.08, 1, 1]")
    running.becomes(np.zeros(6))
    pad_page.evaluate("pad.buttons = pad.buttons.map((button, k) => ({value: k == 1 ? 1 : 0}))")
    running.becomes(vector({REVERSE: 1}))


@pytest.mark.browser
def test_a_gamepad_that_is_unplugged_rests(meshcat, pad_page):
    running = Running(meshcat)
    pad_page.evaluate("pad.axes = [1, 0, 0, 0]")
    running.becomes(vector({K_X: 1}))
    pad_page.evaluate("pad.connected = false")
    running.becomes(np.zeros(6))


@pytest.mark.browser
def test_a_gamepad_whose_page_closes_rests(meshcat, pad_page):
    running = Running(meshcat)
    pad_page.evaluate("pad.axes = [1, 0, 0, 0]")
    running.becomes(vector({K_X: 1}))
    pad_page.close()
    running.becomes(np.zeros(6))


@pytest.mark.browser
def test_a_gamepad_whose_page_closes_rests_though_another_page_stays(chromium, meshcat, pad_page):
    other = chromium.new_page()
    other.goto(meshcat.web_url())
    wait_until(lambda: meshcat.GetNumActiveConnections() == 2, "the other page")
    running = Running(meshcat)
    pad_page.evaluate("pad.axes = [1, 0, 0, 0]")
    running.becomes(vector({K_X: 1}))
    pad_page.close()
    running.becomes(np.zeros(6))
    running.advance(1.0)
    assert not running.joystick.any()
    other.close()
