"""What counts as placed."""

import numpy as np
import pytest

from diagrams.geometry.goals import DrumGoal, MarkGoal

DRUM = DrumGoal(p_WD=np.array([0.0, 0.8, 0.55]), inward=np.array([0.0, 1, 0]), depth=0.33, radius=0.25)
UPRIGHT = np.array([1.0, 0, 0, 0])


def box(center, half=0.05):
    return np.concatenate([np.subtract(center, half), np.add(center, half)])


@pytest.mark.parametrize(
    ("center", "placed"),
    [
        ((0, 0.95, 0.4), True),
        ((0, 0.83, 0.4), False),  # hangs out of the door
        ((0, 0.7, 0.55), False),
        ((0.4, 0.95, 0.4), False),  # beside the drum
        ((0, 0.95, 0.1), False),  # beneath it
        ((0, 1.2, 0.55), False),  # behind it
    ],
)
def test_drum(center, placed):
    assert DRUM.placed(np.array([*center, *UPRIGHT]), box(center)) is placed


@pytest.mark.parametrize(
    ("offset", "quaternion", "placed"),
    [
        ((0, 0, 0), UPRIGHT, True),
        ((0.02, 0.02, 0), UPRIGHT, True),
        ((0.025, 0.025, 0), UPRIGHT, False),
        ((0, 0, -0.4), UPRIGHT, False),  # on the floor beneath its mark
        ((0, 0, 0), np.array([1.0, 0, 0, 1.0]), True),  # turned about the vertical; a quaternion of any norm
        ((0, 0, 0), np.array([np.cos(0.5), np.sin(0.5), 0, 0]), False),  # has fallen over
    ],
)
def test_mark_with_a_cup(offset, quaternion, placed):
    goal = MarkGoal(position=np.array([0.2, 0.5, 0.45]), upright=True)
    assert goal.placed(np.concatenate([goal.position + offset, quaternion]), box(goal.position)) is placed


def test_an_apple_may_roll():
    goal = MarkGoal(position=np.zeros(3))
    assert goal.placed(np.array([0, 0, 0, 0, 1.0, 0, 0]), box(np.zeros(3)))
