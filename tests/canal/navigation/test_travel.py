"""The laws of travelling along a canal (docs/method.md, 4)."""

import math
from dataclasses import replace

import numpy as np
import pytest
from canals import pinched_canal
from hypothesis import given, settings
from hypothesis import strategies as st
from travelling import GRIPPER, REST, REVERSE, START, arch, run, stick

from canal.errors import InputError
from canal.learning import learn_canal
from canal.navigation import (
    FIELD_NAMES,
    Leg,
    NavigationOptions,
    NavigationState,
    disks_per_second,
    initial_state,
    leg_end,
    phase,
    step,
)


def test_nothing_moves_before_start(canal):
    state = run(canal, initial_state(canal), stick(1, 0), 1.0)
    assert state.disk == canal.home_disk
    assert state.eta == 0


def test_cycle_is_home_pick_home_place_home(canal, started):
    options = NavigationOptions(wait_at_ends=False)
    legs, state = [], started
    for _ in range(round(2.05 * canal.moving_time_s / 0.01)):
        state = step(canal, state, REST, 0.01, options=options)
        if not legs or legs[-1] != state.leg:
            legs.append(state.leg)
    assert legs[:5] == [Leg.HOME_TO_PICK, Leg.PICK_TO_HOME, Leg.HOME_TO_PLACE, Leg.PLACE_TO_HOME, Leg.HOME_TO_PICK]


def test_a_pass_takes_the_moving_time(canal, started):
    half = canal.moving_time_s / 2
    before = run(canal, started, REST, half - 0.1)
    after = run(canal, started, REST, half + 0.1)
    assert not before.waiting
    assert after.waiting
    assert phase(canal, after.disk) == -1


def test_waits_at_pick_until_gripped_then_goes_home(canal, started):
    state = run(canal, started, REST, canal.moving_time_s)
    assert state.disk == 0
    assert state.waiting
    state = step(canal, state, GRIPPER, 0.01)
    assert state.gripper_closed
    assert Leg(int(state.leg)) is Leg.PICK_TO_HOME
    paused = run(canal, state, REST, 1.0, gripper_moving=True)
    assert paused.disk == 0, "no motion while the fingers move"
    assert run(canal, state, REST, 1.0).disk > 0
    assert run(canal, state, REST, 2.5, gripper_moving=True).disk > 0, "but not for ever"


def test_release_at_place_goes_home(canal, started):
    end = canal.n_disks - 1.0
    state = replace(started, disk=end, leg=float(Leg.HOME_TO_PLACE), gripper_closed=1.0, anchor_disk=end)
    state = step(canal, step(canal, state, REST, 0.01), GRIPPER, 0.01)
    assert not state.gripper_closed
    assert Leg(int(state.leg)) is Leg.PLACE_TO_HOME


def test_gripper_in_mid_motion_does_not_turn(canal, started):
    state = step(canal, run(canal, started, REST, 1.0), GRIPPER, 0.01)
    assert Leg(int(state.leg)) is Leg.HOME_TO_PICK
    held = run(canal, state, GRIPPER, 1.0)
    assert held.gripper_closed == 1, "a held button is one press"


@pytest.mark.parametrize("disk", [0.0, 17.3, None, -1.0])
def test_corrections_work_everywhere_and_stay_on_the_disk(canal, started, disk):
    disk = canal.home_disk if disk is None else disk % (canal.n_disks - 1) if disk >= 0 else canal.n_disks - 1.0
    state = replace(started, disk=float(disk), anchor_disk=float(disk))
    p = canal.point(state.disk, 0, 0)
    x, y = canal.axes(disk)
    moved = step(canal, state, stick(0.3, -0.4), 0.05)
    expected = (0.3 * x - 0.4 * y) * 20 / 150 * 0.05
    if np.linalg.norm(expected) < canal.radius(disk):
        np.testing.assert_allclose(canal.point(moved.disk, moved.eta, moved.phi) - p, expected, atol=1e-12)
    far = run(canal, state, stick(0.3, -0.4), 5.0)
    assert far.disk == disk
    assert far.eta == pytest.approx(1.0)
    assert far.corrections == 1


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.integers(0, 6)), max_size=40), st.floats(0.005, 0.2))
@settings(max_examples=60, deadline=None)
def test_a_point_never_leaves_its_disk(pushes, dt):
    canal = CANAL
    state = step(canal, initial_state(canal), START, 0.0)
    for k_x, k_y, button in pushes:
        joystick = stick(k_x, k_y)
        if 2 <= button < 5:
            joystick[button] = 1
        state = step(canal, state, joystick, dt)
        assert 0 <= state.eta <= 1 + 1e-12
        assert 0 <= state.disk <= canal.n_disks - 1
        offset = canal.point(state.disk, state.eta, state.phi) - canal.center(state.disk)
        assert np.linalg.norm(offset) <= canal.radius(state.disk) + 1e-12


def test_fixed_strategy_there_and_back_returns(canal, started):
    state = run(canal, run(canal, started, REST, 2.0), stick(1, 0.5), 0.4)
    # Outwards, keeping the ratio, then reversed: homeward converges, so reverse again before it has moved.
    state = step(canal, state, REST, 0.01)
    out = run(canal, state, REST, 1.0)
    assert out.eta == pytest.approx(state.eta, abs=1e-12)
    assert out.phi == state.phi
    back = replace(out, leg=float(Leg.HOME_TO_PICK))
    np.testing.assert_allclose(
        canal.point(state.disk, back.eta, back.phi), canal.point(state.disk, state.eta, state.phi), atol=1e-9
    )


@pytest.mark.parametrize("eta_f", [0.0, 1.0, 0.3])
def test_homeward_ends_at_the_final_ratio(canal, started, eta_f):
    options = NavigationOptions(eta_f=eta_f)
    state = replace(started, disk=3.0, eta=0.8, leg=float(Leg.PICK_TO_HOME), anchor_disk=3.0, anchor_eta=0.8)
    while Leg(int(state.leg)) is Leg.PICK_TO_HOME:
        last, state = state, step(canal, state, REST, 0.01, options=options)
    assert abs(last.eta - eta_f) < 2e-4
    assert abs(state.anchor_eta - eta_f) < 1e-4


def test_paper_decay_is_the_papers_formula(canal, started):
    options = NavigationOptions(decay="paper", decay_lambda=5e-4)
    state = replace(started, disk=3.0, eta=0.8, leg=float(Leg.PICK_TO_HOME), anchor_disk=3.0, anchor_eta=0.8)
    later = run(canal, state, REST, 2.0, options=options)
    assert later.eta == pytest.approx(0.8 * math.exp(-5e-4 * (later.disk - 3.0)), rel=1e-12)


@given(st.floats(0.0, 20.0), st.integers(2, 10))
@settings(max_examples=30, deadline=None)
def test_the_control_rate_changes_nothing(start, parts):
    options = NavigationOptions(wait_at_ends=False)
    state = step(CANAL, initial_state(CANAL), START, 0.0)
    state = run(CANAL, state, REST, start, dt=0.1, options=options)
    once = step(CANAL, state, REST, 0.1, options=options)
    often = run(CANAL, state, REST, 0.1, dt=0.1 / parts, options=options)
    assert once.leg == often.leg
    assert once.disk == pytest.approx(often.disk, abs=1e-9)
    assert once.eta == pytest.approx(often.eta, abs=1e-9)


def test_reversal_keeps_disks_frames_and_mapping(canal, started):
    state = run(canal, started, REST, 3.0)
    reversed_ = step(canal, state, REVERSE, 0.0)
    assert reversed_.disk == state.disk
    assert Leg(int(reversed_.leg)) is Leg.PICK_TO_HOME
    assert reversed_.backtracks == 1
    there, back = step(canal, state, stick(1, 0), 0.05), step(canal, reversed_, stick(1, 0), 0.05)
    assert (there.eta, there.phi) == (back.eta, back.phi)


@pytest.mark.parametrize("half_width", [0.1, 0.4])
@pytest.mark.parametrize("before_home", [0.05, 0.5, 3.0, 20.0])
@pytest.mark.parametrize("options", [NavigationOptions(), NavigationOptions(decay="paper", decay_lambda=5.0)])
def test_close_to_home_nothing_jumps(half_width, before_home, options):
    canal = pinched_canal(half_width)
    speed = disks_per_second(canal, options) * float(np.diff(canal.arc).max())
    disk = canal.home_disk - before_home
    outward = replace(initial_state(canal), disk=disk, eta=1.0, phi=0.3, anchor_eta=1.0, running=1.0)
    corrected = replace(outward, leg=float(Leg.PICK_TO_HOME), anchor_disk=disk, correcting=1.0)
    for state, joystick in ((outward, REVERSE), (corrected, REST)):
        for _ in range(200):
            after = step(canal, state, joystick, 0.02, options=options)
            taken = abs(after.eta - state.eta) * canal.radius(after.disk)
            assert taken <= speed * 0.02 * (1 + 1e-6)
            state, joystick = after, REST


@pytest.mark.parametrize("speed_scale", [1e2, 1e6, 1e12])
def test_a_step_does_bounded_work_at_any_speed(canal, started, speed_scale):
    options = NavigationOptions(wait_at_ends=False)
    fast = replace(canal, moving_time_s=canal.moving_time_s / speed_scale)
    state = step(fast, started, REST, 0.1, options=options)
    assert 0 <= state.disk <= canal.n_disks - 1
    assert 0 <= state.eta <= 1
    # Whole cycles lead back to where they began.
    left = math.fmod(disks_per_second(fast, options) * 0.1, 2 * (canal.n_disks - 1))
    slow = step(canal, started, REST, left / disks_per_second(canal, options), options=options)
    assert (state.disk, state.leg) == (pytest.approx(slow.disk, abs=1e-3), slow.leg)


def test_zero_radius_carries_the_ratio_through(started):
    canal = learn_canal([arch(0.1), arch(0.1)])
    assert canal.radii.max() < 1e-9
    state = replace(step(canal, initial_state(canal), START, 0.0), eta=0.5, anchor_eta=0.5)
    assert step(canal, state, stick(1, 0), 0.05).eta == 0.5
    assert run(canal, state, REST, 1.0).eta == 0.5


def test_vector_round_trip(canal, started):
    state = run(canal, started, REST, 1.0)
    assert NavigationState.from_vector(state.to_vector()) == state
    assert len(FIELD_NAMES) == state.to_vector().size


def test_speed_scale(canal):
    assert disks_per_second(canal, NavigationOptions(speed_scale=2)) == pytest.approx(
        2 * (canal.n_disks - 1) / canal.moving_time_s
    )
    assert leg_end(canal, Leg.HOME_TO_PLACE) == canal.n_disks - 1


@pytest.mark.parametrize(
    "wrong", [{"speed_scale": 0}, {"speed_scale": 1e12}, {"delta": math.nan}, {"eta_f": 2}, {"decay": "cubic"}]
)
def test_wrong_options_are_refused(wrong):
    with pytest.raises(InputError, match=next(iter(wrong))):
        NavigationOptions(**wrong)


CANAL = learn_canal([arch(-0.1), arch(0.1)])
"""Hypothesis draws against a module's constant: its fixtures would be built anew."""
