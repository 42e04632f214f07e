"""Jogging: how a hand that asks for a motion of the tool moves a wanted pose. Plain arithmetic, no Drake systems."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from canal.navigation.pressing import DECISIVE

JOG_SIZE = 7
"""A jog: velocity of the tool (3), which way its nose is to tip (3), both in the base frame, and its spin (1); shares
of the full speeds, in the unit ball each."""
MOVE, NOSE, SPIN = slice(0, 3), slice(3, 6), 6
"""Places in it."""

SPEED = 0.10
"""[m/s] At full push: what teach pendants allow at most beside a person is 0.25 (ISO 10218-1); a 1 m path in 10 s."""
TURN_SPEED = 0.6
"""[rad/s] A quarter turn in 2.6 s."""
LEAD, TURN_LEAD = 0.004, math.radians(2.0)
"""[m], [rad] How far the wanted pose may be ahead of what the arm is commanded to: a control period at full speed is
1 mm and 0.3°; more means that the arm cannot follow."""
NEAR_AXIS = 0.15
"""[m] From the robot's vertical axis: nearer, the tool does not turn with the arm."""
ALONG = 0.2
"""Sine of the angle between the nose and the way it is to tip below which it slows down, to end there."""


def clean_jog(jog: ArrayLike) -> np.ndarray:
    """A jog with each part within its unit ball, and zero where it is not finite. Shape (7,)."""
    values = np.asarray(jog, dtype=float)
    if values.shape != (JOG_SIZE,) or not np.isfinite(values).all():
        return np.zeros(JOG_SIZE)
    values = np.clip(values, -1e6, 1e6)
    for part in (MOVE, NOSE):
        values[part] /= max(float(np.linalg.norm(values[part])), 1.0)
    values[SPIN] = min(max(values[SPIN], -1.0), 1.0)
    return values


def jogged(pose: np.ndarray, jog: np.ndarray, dt: float) -> np.ndarray:
    """A pose moved by a jog.

    Args:
        pose: position and quaternion. Shape (7,).
        jog: clean. Shape (7,).
        dt: how long, [s].

    Returns:
        The pose after it. The tool's nose, its x axis, tips the way that is asked for, as far as that is across it;
        spin turns the tool about its nose. Where the tool moves around the robot's vertical axis, it turns with the
        arm: held in one direction it would run into a stop of the wrist within 60° of swing. Shape (7,).
    """
    moved = np.array(pose, dtype=float)
    moved[:3] += SPEED * dt * jog[MOVE]
    turn = np.array((0.0, 0.0, _swing(pose[:3], moved[:3])))
    R_BT = Rotation.from_quat(pose[3:], scalar_first=True)
    if jog[3:].any():
        nose = R_BT.apply((1.0, 0.0, 0.0))
        asked = np.cross(nose, _across(jog[NOSE], nose)) + jog[SPIN] * nose
        turn += asked * TURN_SPEED * dt / max(float(np.linalg.norm(asked)), 1.0)
    if turn.any():
        moved[3:] = (Rotation.from_rotvec(turn) * R_BT).as_quat(scalar_first=True)
    return moved


def _swing(before: np.ndarray, after: np.ndarray) -> float:
    """By how much a point has moved around the robot's vertical axis, [rad]; nothing near to that axis."""
    if min(np.hypot(*before[:2]), np.hypot(*after[:2])) < NEAR_AXIS:
        return 0.0
    x, y, u, v = *before[:2], *after[:2]
    return math.atan2(x * v - y * u, x * u + y * v)


def _across(way: np.ndarray, nose: np.ndarray) -> np.ndarray:
    """The part of a way across the nose, as long as the way itself; shorter where the nose nearly points that way."""
    length = float(np.linalg.norm(way))
    across = way - (way @ nose) * nose
    return across * (length / max(float(np.linalg.norm(across)), ALONG * length, 1e-12))


def off(pose: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """How far two poses are apart.

    Args:
        pose: position and quaternion. Shape (7,).
        other: likewise.

    Returns:
        Distance [m] and angle [rad].
    """
    return (
        float(np.linalg.norm(pose[:3] - other[:3])),
        2.0 * math.acos(min(1.0, abs(float(pose[3:] @ other[3:])))),
    )


def ahead(wanted: np.ndarray, reached: np.ndarray) -> float:
    """How far a wanted pose is ahead of the arm, as a share of what it may be: above 1 the arm cannot follow.

    Args:
        wanted: shape (7,).
        reached: what the arm is commanded to. Shape (7,).
    """
    far, turned = off(wanted, reached)
    return max(far / LEAD, turned / TURN_LEAD)


def next_wanted(wanted: np.ndarray, reached: np.ndarray, jog: np.ndarray, dt: float) -> np.ndarray:
    """The wanted pose a control period later: it waits while the arm is behind it.

    At the end of the arm's reach, or of its speed, it stands still; a push back moves it at once. Where only the wrist
    is at a stop, a motion goes on and the tool tilts with it. Once nobody pushes, a pose that cannot be reached is
    given up for the one that was.

    Args:
        wanted: now. Shape (7,).
        reached: what the arm is commanded to. Shape (7,).
        jog: clean. Shape (7,).
        dt: control period, [s].
    """
    before = ahead(wanted, reached)
    if not jog.any():
        return reached if before > 1.0 else wanted
    moved = jogged(wanted, jog, dt)
    if not jog[3:].any() and off(moved, reached)[1] > TURN_LEAD:
        moved[3:] = reached[3:]
    after = ahead(moved, reached)
    return moved if after <= 1.0 or after < before else wanted


def towards(wanted: np.ndarray, goal: np.ndarray, dt: float, share: float = 1.5) -> np.ndarray:
    """A wanted pose moved towards another one, no faster than `share` of the full speeds.

    Args:
        wanted: shape (7,).
        goal: shape (7,).
        dt: control period, [s].
        share: of the full speeds.
    """
    moved = np.array(wanted, dtype=float)
    way = goal[:3] - wanted[:3]
    moved[:3] += way * min(1.0, share * SPEED * dt / max(float(np.linalg.norm(way)), 1e-9))
    R_BT = Rotation.from_quat(wanted[3:], scalar_first=True)
    turn = (Rotation.from_quat(goal[3:], scalar_first=True) * R_BT.inv()).as_rotvec()
    turn *= min(1.0, share * TURN_SPEED * dt / max(float(np.linalg.norm(turn)), 1e-9))
    moved[3:] = (Rotation.from_rotvec(turn) * R_BT).as_quat(scalar_first=True)
    return moved


def not_pressing(jog: np.ndarray, alarm: Sequence[float]) -> np.ndarray:
    """A jog without what presses further on what the robot presses on already.

    Args:
        jog: clean. Shape (7,).
        alarm: force that is above its limit [N], 0 for none, and the net force on the hand [N]. Shape (4,).

    Returns:
        While the alarm lasts: what leads away from the contact; nothing turns. Nothing at all where the contacts agree
        on no direction: the way back along the path is free. Shape (7,).
    """
    limit, force = alarm[0], np.asarray(alarm[1:], dtype=float)
    if not limit > 0:
        return jog
    free = np.zeros(JOG_SIZE)
    size = float(np.linalg.norm(force))
    if math.isfinite(size) and size > 0 and size >= DECISIVE * limit:
        away = force / size
        free[MOVE] = jog[MOVE] - min(0.0, float(jog[MOVE] @ away)) * away
    return free
