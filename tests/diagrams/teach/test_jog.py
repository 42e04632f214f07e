"""Jogging: speeds, directions, and what happens where the arm cannot follow."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from diagrams.teach.jog import (
    LEAD,
    MOVE,
    NOSE,
    SPEED,
    SPIN,
    TURN_SPEED,
    ahead,
    clean_jog,
    jogged,
    next_wanted,
    not_pressing,
    off,
    towards,
)

DOWN = Rotation.from_euler("y", 90, degrees=True)  # the nose, x of the tool, points down


def pose(x=0.4, y=0.0, z=0.5, R=DOWN):
    return np.array([x, y, z, *R.as_quat(scalar_first=True)])


def jog(**parts):
    made = np.zeros(7)
    for name, value in parts.items():
        made[{"move": MOVE, "nose": NOSE, "spin": SPIN}[name]] = value
    return made


def nose(pose):
    return Rotation.from_quat(pose[3:], scalar_first=True).apply([1.0, 0.0, 0.0])


numbers = st.floats(allow_nan=True, allow_infinity=True)


@given(st.lists(numbers, min_size=7, max_size=7))
def test_whatever_comes_is_clamped(values):
    clean = clean_jog(values)
    assert np.isfinite(clean).all()
    assert max(np.linalg.norm(clean[MOVE]), np.linalg.norm(clean[NOSE]), abs(clean[SPIN])) <= 1 + 1e-12


@given(
    st.lists(st.floats(-1, 1), min_size=7, max_size=7),
    st.floats(0, 2 * math.pi),
    st.floats(0.2, 0.8),
)
def test_nothing_is_faster_than_the_full_speeds(values, around, radius):
    start = pose(radius * math.cos(around), radius * math.sin(around))
    far, turned = off(jogged(start, clean_jog(values), 0.01), start)
    assert far <= SPEED * 0.01 + 1e-12
    # Turning with the arm comes on top: its swing, and never more.
    assert turned <= (TURN_SPEED + SPEED / 0.19) * 0.01 + 1e-7


def test_the_nose_tips_the_way_that_is_asked_for_and_ends_there():
    tipped = pose()
    for _ in range(100):
        tipped = jogged(tipped, jog(nose=[0, 1, 0]), 0.01)
    assert nose(tipped) == pytest.approx([0, math.sin(0.6), -math.cos(0.6)], abs=0.01)
    for _ in range(600):
        tipped = jogged(tipped, jog(nose=[0, 1, 0]), 0.01)
    assert nose(tipped) == pytest.approx([0, 1, 0], abs=0.01)
    assert off(jogged(tipped, jog(nose=[0, 1, 0]), 0.01), tipped)[1] < 1e-3, "it does not tremble there"


def test_spin_turns_about_the_nose():
    spun = jogged(pose(), jog(spin=1.0), 0.1)
    assert nose(spun) == pytest.approx(nose(pose()))
    assert off(spun, pose())[1] == pytest.approx(0.1 * TURN_SPEED)


def test_the_tool_turns_with_the_arm():
    """A quarter of a circle around the robot turns the tool by a quarter: seen from the arm it has not turned."""
    start = moved = pose(0.4, 0.0)
    for angle in np.linspace(0, math.pi / 2, 2000):
        moved = jogged(moved, jog(move=[-math.sin(angle), math.cos(angle), 0]), 0.4 * math.pi / 2 / 2000 / SPEED)
    swing = Rotation.from_euler("z", math.atan2(moved[1], moved[0]))
    assert off(moved, np.array([*moved[:3], *(swing * DOWN).as_quat(scalar_first=True)]))[1] < 1e-6
    assert off(moved, start)[1] > 1.5


def test_at_the_end_of_the_reach_it_waits_and_comes_back_at_once():
    wanted = reached = pose()
    for _ in range(100):
        wanted = next_wanted(wanted, reached, jog(move=[1, 0, 0]), 0.01)  # the arm stays where it is
    assert 0.5 * LEAD < off(wanted, reached)[0] <= LEAD + 1e-9
    assert off(next_wanted(wanted, reached, jog(move=[-1, 0, 0]), 0.01), reached)[0] < off(wanted, reached)[0]


def test_where_the_wrist_is_at_a_stop_a_motion_goes_on_and_the_tool_tilts():
    tilted = Rotation.from_euler("x", 5, degrees=True) * DOWN
    wanted, reached = pose(), pose(R=tilted)
    moved = next_wanted(wanted, reached, jog(move=[0, 0, 1]), 0.01)
    assert moved[2] > wanted[2]
    assert off(moved, reached)[1] < 1e-6
    assert np.array_equal(next_wanted(wanted, reached, jog(spin=1.0), 0.01)[:3], wanted[:3])


def test_what_cannot_be_reached_is_given_up_when_nobody_pushes():
    wanted, reached = pose(x=0.5), pose(x=0.48)
    assert ahead(wanted, reached) > 1
    assert np.array_equal(next_wanted(wanted, reached, jog(), 0.01), reached)
    assert np.array_equal(next_wanted(pose(x=0.482), reached, jog(), 0.01), pose(x=0.482))


def test_what_presses_is_held_and_the_way_out_is_free():
    alarm = (160.0, 0.0, 0.0, 160.0)  # the table pushes up
    down, aside = jog(move=[0, 0, -1], nose=[1, 0, 0], spin=1), jog(move=[0.6, 0, -0.8])
    assert not not_pressing(down, alarm).any()
    assert not_pressing(aside, alarm).tolist() == pytest.approx([0.6, 0, 0, 0, 0, 0, 0])
    assert np.array_equal(not_pressing(jog(move=[0, 0, 1]), alarm), jog(move=[0, 0, 1]))
    assert np.array_equal(not_pressing(down, (0.0, 0.0, 0.0, 0.0)), down)
    assert not not_pressing(jog(move=[0, 0, 1]), (160.0, 10.0, 0.0, 0.0)).any(), "wedged: the forces agree on no way"


def test_the_way_back_is_led_no_faster_than_the_arm_goes():
    goal = pose(x=0.6, R=Rotation.from_euler("x", 40, degrees=True) * DOWN)
    step = towards(pose(), goal, 0.01)
    assert off(step, pose()) == pytest.approx((1.5 * SPEED * 0.01, 1.5 * TURN_SPEED * 0.01), rel=1e-6)
    assert off(towards(goal, goal, 0.01), goal) == pytest.approx((0, 0), abs=1e-7)
