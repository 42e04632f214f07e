"""While the robot presses on something: nothing moves further in, and the way back is free."""

from dataclasses import replace

import numpy as np
import pytest
from canals import canal_above_tables, pinched_canal

from canal.navigation import Ignored, Leg, NavigationState, initial_state, step

REST = np.zeros(6)
GRIPPER, REVERSE, START, STOP = np.eye(6)[2:]
DT = 0.02


def stick(k_x: float, k_y: float) -> np.ndarray:
    return np.array([k_x, k_y, 0, 0, 0, 0])


@pytest.fixture(scope="module")
def canal():
    return pinched_canal()


def run(canal, state, joystick, seconds, **kwargs):
    for _ in range(round(seconds / DT)):
        state = step(canal, state, joystick, DT, **kwargs)
    return state


def along(canal, disk: float) -> np.ndarray:
    chord = canal.center(disk + 1) - canal.center(disk - 1)
    return chord / np.linalg.norm(chord)


@pytest.fixture
def going(canal) -> NavigationState:
    """On the way to pick, which is where the disks fall to 0."""
    return run(canal, step(canal, initial_state(canal), START, 0.0), REST, 3.0)


def against_travel(canal, state) -> dict:
    """A wall ahead: the force on the hand points back, up the disks."""
    return {"alarm": 200.0, "force": 200.0 * along(canal, state.disk)}


UNKNOWN = {"alarm": 200.0}
"""A contact of the arm, or from two sides: the net force on the hand tells nothing."""


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("press", [REST, START, GRIPPER, REVERSE])
def test_a_press_in_the_tick_of_the_blow_swallows_nothing(canal, going, press, known):
    wall = against_travel(canal, going) if known else UNKNOWN
    state = run(canal, step(canal, going, press, DT, **wall), REST, 2.0, **wall)
    if press is REVERSE:
        assert state.disk > going.disk
    else:
        assert state.disk == going.disk
        assert state.blocked or (press is START and state.paused)
    assert state.gripper_closed == (press is GRIPPER)


@pytest.mark.parametrize("known", [True, False])
def test_start_does_not_drive_on_and_is_told_why(canal, going, known):
    wall = against_travel(canal, going) if known else UNKNOWN
    blocked = run(canal, going, REST, 0.1, **wall)
    state = run(canal, step(canal, blocked, START, DT, **wall), REST, 2.0, **wall)
    assert state.disk == blocked.disk
    assert not state.paused
    assert (state.ignored, state.ignored_why) == (blocked.ignored + 1, Ignored.PRESSING)


def test_it_goes_on_by_itself_when_the_force_is_gone(canal, going):
    blocked = run(canal, going, REST, 1.0, **against_travel(canal, going))
    after = step(canal, blocked, REST, DT)
    assert not after.blocked
    assert after.disk < blocked.disk


def test_the_way_back_is_free_to_its_end_though_the_force_stays(canal, going):
    blocked = run(canal, going, REST, 0.1, **UNKNOWN)
    back = run(canal, step(canal, blocked, REVERSE, DT, **UNKNOWN), REST, 30.0, **UNKNOWN)
    assert back.disk == canal.n_disks - 1
    assert back.waiting


@pytest.mark.parametrize("known", [True, False])
def test_after_a_grip_near_pick_reverse_does_not_lead_further_in(canal, going, known):
    near = replace(going, disk=5.0, anchor_disk=5.0)
    wall = against_travel(canal, near) if known else UNKNOWN
    gripped = run(canal, step(canal, run(canal, near, REST, 0.1, **wall), GRIPPER, DT, **wall), REST, 0.1, **wall)
    assert gripped.gripper_closed
    assert Leg(int(gripped.leg)) is Leg.PICK_TO_HOME
    reversed_ = run(canal, step(canal, gripped, REVERSE, DT, **wall), REST, 3.0, **wall)
    assert reversed_.disk <= near.disk + 1e-9
    assert reversed_.disk == pytest.approx(near.disk, abs=1e-9)
    home = run(canal, gripped, REST, 3.0, **wall)
    assert home.disk > near.disk + 10


@pytest.mark.parametrize("angle", np.arange(0, 2 * np.pi, 0.7))
def test_a_correction_into_a_wall_goes_no_further_and_is_steered_back_out(canal, going, angle):
    at = replace(going, disk=2.0, eta=0.0, anchor_disk=2.0)
    x, y = canal.axes(at.disk)
    into = np.cos(angle) * x + np.sin(angle) * y
    wall = {"alarm": 160.0, "force": -160.0 * into}
    pushed = run(canal, at, stick(np.cos(angle), np.sin(angle)), 0.2)
    p = canal.point(pushed.disk, pushed.eta, pushed.phi)

    def moved(k_x, k_y):
        state = run(canal, pushed, stick(k_x, k_y), 0.2, **wall)
        return state, canal.point(state.disk, state.eta, state.phi) - p

    for turn in (0, 0.5, -0.5, 1.2, -1.2):
        state, way = moved(np.cos(angle + turn), np.sin(angle + turn))
        assert way @ into <= 1e-9
        assert state.blocked
        # What slides along the wall is free.
        assert np.linalg.norm(way) == pytest.approx(abs(np.sin(turn)) * 0.2 * 20 / 150, rel=0.1, abs=1e-9)
    for turn in (np.pi, np.pi / 2 + 0.1, -np.pi / 2 - 0.1):
        state, way = moved(np.cos(angle + turn), np.sin(angle + turn))
        assert not state.blocked
        assert np.linalg.norm(way) > 0.02


def test_a_correction_between_two_walls_is_known_by_the_stick(canal, going):
    at = run(canal, replace(going, disk=2.0, anchor_disk=2.0), stick(1, 0), 0.1)
    held = run(canal, at, stick(1, 0), 0.3, **UNKNOWN)
    assert held.eta == at.eta
    out = run(canal, held, stick(-1, 0), 0.1, **UNKNOWN)
    assert out.eta < at.eta


def test_along_the_rim_nothing_slides_into_what_it_presses_on(canal, going):
    # The stick points along the wall and beyond the rim: what is left of it, on the disk, would lead into the wall.
    rim = replace(going, disk=2.0, eta=1.0, phi=0.0, anchor_disk=2.0, anchor_eta=1.0)
    x, y = canal.axes(rim.disk)
    into = -np.cos(0.6) * x + np.sin(0.6) * y
    state = run(canal, rim, stick(np.sin(0.6), np.cos(0.6)), 0.2, alarm=160.0, force=-160.0 * into)
    moved = canal.point(state.disk, state.eta, state.phi) - canal.point(rim.disk, rim.eta, rim.phi)
    assert moved @ into <= 1e-9


def test_the_ratio_is_kept_while_backing_off(canal, going):
    at = replace(going, eta=0.8, anchor_eta=0.8)
    back = run(canal, step(canal, run(canal, at, REST, 0.1, **UNKNOWN), REVERSE, DT, **UNKNOWN), REST, 1.0, **UNKNOWN)
    assert back.eta == 0.8
    assert run(canal, back, REST, 4.0).eta < 0.1, "and then decays"


def test_what_is_not_finite_is_no_direction(canal, going):
    state = run(canal, going, REST, 1.0, alarm=200.0, force=(np.nan, 0.0, np.inf))
    assert state.disk == going.disk
    assert np.isfinite(state.to_vector()).all()
    assert run(canal, going, REST, 1.0, alarm=np.nan).disk < going.disk


def test_a_push_into_a_table_does_not_slide_faster_than_the_stick():
    canal = canal_above_tables()
    for angle in np.arange(0, 2 * np.pi, 0.1):
        for disk in (0.0, 3.0, canal.n_disks - 1.0):
            for push in np.arange(0, 2 * np.pi, 0.5):
                state = replace(initial_state(canal), disk=disk, eta=1.0, phi=angle, running=1.0)
                after = step(canal, state, stick(np.cos(push), np.sin(push)), DT)
                moved = canal.point(disk, after.eta, after.phi) - canal.point(disk, 1.0, angle)
                assert np.linalg.norm(moved) <= DT * 20 / 150 * (1 + 1e-6)
