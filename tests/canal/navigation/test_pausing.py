"""Stop, pause and start again (paper V-E: at any moment)."""

from dataclasses import replace

from travelling import GRIPPER, REST, REVERSE, START, STOP, run, stick

from canal.navigation import (
    Ignored,
    Leg,
    step,
)


def test_start_while_travelling_pauses_on_the_disk_and_again_goes_on(canal, started):
    state = run(canal, started, REST, 2.0)
    paused = run(canal, step(canal, state, START, 0.01), REST, 3.0)
    assert paused.disk == state.disk
    assert paused.paused
    corrected = run(canal, paused, stick(1, 0), 0.3)
    assert corrected.eta > 0.1, "corrections work"
    gripped = run(canal, step(canal, corrected, GRIPPER, 0.01), REST, 1.0)
    assert gripped.gripper_closed, "so does the gripper"
    reversed_ = run(canal, step(canal, gripped, REVERSE, 0.01), REST, 1.0)
    assert Leg(int(reversed_.leg)) is Leg.PICK_TO_HOME, "and reverse"
    assert reversed_.disk == state.disk
    on = run(canal, step(canal, reversed_, START, 0.01), REST, 0.5)
    assert on.disk > state.disk
    assert (on.ignored, on.paused) == (0, 0)


def test_stop_freezes_everything_until_start_and_tells_why(canal, started):
    state = run(canal, started, REST, 2.0)
    stopped = step(canal, state, STOP, 0.01)
    frozen = replace(stopped, held_stop=0.0)
    for count, joystick in enumerate((GRIPPER, REVERSE, stick(1, 0)), 1):
        frozen = run(canal, run(canal, frozen, joystick, 0.2), REST, 0.2)
        assert (frozen.disk, frozen.eta, frozen.leg, frozen.gripper_closed) == (state.disk, 0, state.leg, 0)
        assert (frozen.ignored, frozen.ignored_why) == (count, Ignored.STOPPED)
    again = step(canal, frozen, STOP, 0.01)
    assert (again.ignored, again.ignored_why) == (4, Ignored.ALREADY_STOPPED)
    on = run(canal, step(canal, run(canal, again, REST, 0.1), START, 0.01), REST, 0.5)
    assert on.disk < state.disk
    assert not on.paused


def test_stop_wins_over_start(canal, started):
    state = run(canal, started, REST, 1.0)
    both = step(canal, state, START + STOP, 0.01)
    assert not both.running
    held = step(canal, step(canal, both, STOP, 0.01), START + STOP, 0.01)
    assert not held.running
    assert held.ignored_why == Ignored.STOP_HELD


def test_a_pause_ends_with_a_stop(canal, started):
    paused = step(canal, run(canal, started, REST, 1.0), START, 0.01)
    stopped = step(canal, step(canal, paused, REST, 0.01), STOP, 0.01)
    on = step(canal, step(canal, stopped, REST, 0.01), START, 0.01)
    assert run(canal, on, REST, 0.5).disk < paused.disk


def test_start_while_waiting_is_told_what_goes_on(canal, started):
    waiting = run(canal, started, REST, canal.moving_time_s)
    assert waiting.waiting
    state = run(canal, step(canal, waiting, START, 0.01), REST, 1.0)
    assert (state.disk, state.paused) == (0, 0)
    assert (state.ignored, state.ignored_why) == (1, Ignored.WAITING)
