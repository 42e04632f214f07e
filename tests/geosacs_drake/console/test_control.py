"""Who steers, and what becomes of a command that nobody confirms."""

import numpy as np
import pytest

from canal.navigation.joystick import GRIPPER, REVERSE, START, STOP
from geosacs_drake.console.control import STALE_S, Control


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def control(clock) -> Control:
    return Control(clock=clock)


def stick(control):
    return tuple(control.sample().joystick[:2])


def pressed(control, button, samples=8):
    return [control.sample().joystick[button] for _ in range(samples)]


def test_a_stick_that_nobody_confirms_falls_to_its_centre(control, clock):
    control.drive("a", (0.5, -0.5))
    clock.now += 0.9 * STALE_S
    assert stick(control) == (0.5, -0.5)
    control.drive("a", (0.5, -0.5))
    clock.now += 0.9 * STALE_S
    assert stick(control) == (0.5, -0.5)
    clock.now += 0.2 * STALE_S
    assert stick(control) == (0.0, 0.0)


def test_a_command_that_comes_late_is_not_carried_out(control):
    control.drive("a", (1.0, 0.0), age_s=1.1 * STALE_S)
    assert control.press("a", "gripper", age_s=1.1 * STALE_S)
    assert not control.sample().joystick.any()


def test_a_push_between_two_samples_is_one_sample_long(control):
    control.drive("a", (0.2, 0.0))
    control.drive("a", (0.0, 0.0))
    assert [stick(control) for _ in range(3)] == [(0.2, 0.0), (0.0, 0.0), (0.0, 0.0)]


def test_presses_are_one_sample_long_and_apart(control):
    control.press("a", "gripper")
    control.press("a", "gripper")
    assert pressed(control, GRIPPER) == [1, 0, 1, 0, 0, 0, 0, 0]


def test_touching_takes_over_and_only_one_page_steers(control):
    assert not control.sample().in_charge
    control.drive("a", (0.1, 0.0))
    assert control.sample().in_charge
    assert control.drive("b", (0.0, 1.0))
    assert control.press("b", "reverse")
    assert stick(control) == (0.1, 0.0)
    assert control.take("b") == ""
    assert stick(control) == (0.0, 0.0)
    assert control.drive("a", (1.0, 0.0))
    control.drive("b", (0.0, 1.0))
    assert stick(control) == (0.0, 1.0)


def test_resting_hands_take_nothing_over(control):
    control.drive("a", (0.0, 0.0))
    assert control.situation().holder == ""
    assert not control.sample().in_charge


def test_any_page_stops_and_nothing_but_start_moves_it_again(control):
    control.drive("a", (1.0, 0.0))
    assert control.press("b", "stop", age_s=10.0) == ""
    assert stick(control) == (0.0, 0.0)
    assert control.press("a", "gripper")
    assert control.drive("a", (1.0, 0.0))
    assert control.hand_back("a")
    assert not pressed(control, GRIPPER, 4)[0]
    assert control.situation().stopped
    assert control.press("b", "start"), "another page is in control"
    assert control.press("a", "start") == ""
    assert pressed(control, START)[0] == 1
    control.drive("a", (1.0, 0.0))
    assert stick(control) == (1.0, 0.0)


def test_stop_is_pressed_once(control):
    control.press("a", "stop")
    assert pressed(control, STOP) == [1, 0, 0, 0, 0, 0, 0, 0]


def test_handing_back_gives_the_task_to_the_simulated_operator_and_taking_takes_it(control):
    control.press("a", "start")
    control.drive("a", (1.0, 0.0))
    assert control.hand_back("b")
    assert control.hand_back("a") == ""
    sample = control.sample()
    assert not sample.in_charge
    assert not sample.joystick.any()
    control.take("a")
    assert control.sample().in_charge


def test_a_page_that_goes_lets_go_of_everything(control):
    control.drive("a", (1.0, 0.0))
    control.press("a", "reverse")
    control.leave("a")
    assert not control.sample().joystick.any()
    assert pressed(control, REVERSE) == [0] * 8
    assert control.drive("b", (0.0, 1.0)) == ""


def test_a_step_is_as_many_samples_as_it_takes_and_then_the_centre(control):
    control.step("a", [(0.3, 0.0)] * 2)
    assert [stick(control)[0] for _ in range(4)] == [0.3, 0.3, 0.0, 0.0]


def test_it_begins_with_start_watch_or_handing_back(clock):
    for begin in (lambda c: c.press("a", "start"), lambda c: c.watch(), lambda c: c.hand_back("a")):
        control = Control(clock=clock)
        assert not control.wait_for_beginning(0.0)
        begin(control)
        assert control.wait_for_beginning(0.0)


def test_random_commands_never_move_a_stopped_robot(control, clock):
    rng = np.random.default_rng(0)
    control.press("a", "stop")
    control.sample()
    for _ in range(2000):
        page = "ab"[rng.integers(2)]
        match rng.integers(5):
            case 0:
                control.drive(page, tuple(rng.uniform(-1, 1, 2)))
            case 1:
                control.press(page, ("gripper", "reverse", "stop")[rng.integers(3)])
            case 2:
                control.step(page, [tuple(rng.uniform(-1, 1, 2))])
            case 3:
                control.take(page)
            case 4:
                control.hand_back(page)
        clock.now += rng.exponential(0.05)
        assert not np.delete(control.sample().joystick, STOP).any()
        assert control.situation().person
