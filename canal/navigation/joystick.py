"""The joystick vector (paper V-D): two axes, four buttons, sampled at 20 Hz; and periods that keep step with it.

A device (a page, a recording, a program) hands on a clean vector: `clean_joystick`, and a dead zone of its own where
sticks do not return to 0. Everything after it trusts the vector.
"""

import math
from fractions import Fraction

import numpy as np

JOYSTICK_SIZE = 6
"""Joystick vector: k_x, k_y in [-1, 1], then the levels (0 or 1) of the buttons gripper, reverse, start, stop."""
K_X, K_Y, GRIPPER, REVERSE, START, STOP = range(JOYSTICK_SIZE)
"""Indices in it: the stick along the disk's correction axes x and y, then the buttons."""

_PARTS = 3 * 3 * 5 * 5 * 7
JOYSTICK_PERIOD = _PARTS * (round(0.05 / _PARTS * 2**57) / 2**57)
"""[s] A joystick is sampled at 20 Hz (paper V-D). 0.05 to 1e-13, and exactly divisible by what rates have in common:
k samples and 3 k ticks of 60 Hz end at the same floating-point time for every k. With 0.05 and 1/60 as they are, two in
five do not, and which of two events comes first would change from tick to tick."""


def clean_joystick(values: np.ndarray) -> np.ndarray:
    """A joystick vector from whatever a device gave: what is not finite becomes 0, buttons become 0 or 1.

    Args:
        values: k_x, k_y, and the levels of the four buttons. Shape (6,).

    Returns:
        The vector with the stick within the unit disc; the same again, bit for bit, if it was clean. Shape (6,).
    """
    k_x, k_y, *levels = (v if math.isfinite(v) else 0.0 for v in np.asarray(values, dtype=float).tolist())
    return np.array((*in_unit_disc(k_x, k_y), *(float(level > 0.5) for level in levels)))


def in_unit_disc(k_x: float, k_y: float) -> tuple[float, float]:
    """A finite stick, shortened to length 1 where it is longer.

    Args:
        k_x: along the correction axis x.
        k_y: along the correction axis y.
    """
    k_x, k_y = min(max(k_x, -1.0), 1.0), min(max(k_y, -1.0), 1.0)
    norm = math.hypot(k_x, k_y)
    # The margin makes doing it twice the same as once, bit for bit.
    return (k_x / norm, k_y / norm) if norm > 1 + 1e-9 else (k_x, k_y)


def in_step(seconds: float) -> float:
    """A period that keeps step with the joystick's where one is meant: 1/60 becomes exactly a third of its period.

    Args:
        seconds: wanted, [s].

    Returns:
        The nearest simple fraction of `JOYSTICK_PERIOD` (denominators up to 100) if it is within 1e-6 of the wanted
        period, else the wanted one.
    """
    ratio = Fraction(seconds / JOYSTICK_PERIOD).limit_denominator(100)
    near = JOYSTICK_PERIOD * ratio.numerator / ratio.denominator
    return near if abs(near - seconds) <= 1e-6 * seconds else seconds
