"""The joystick vector (paper V-D): two axes, four buttons, sampled at 20 Hz; and periods that keep step with it."""

from fractions import Fraction

JOYSTICK_SIZE = 6
"""Joystick vector: k_x, k_y in [-1, 1], then the levels (0 or 1) of the buttons gripper, reverse, start, stop."""
K_X, K_Y, GRIPPER, REVERSE, START, STOP = range(JOYSTICK_SIZE)
"""Indices in it: the stick along the disk's correction axes x and y, then the buttons."""

_PARTS = 3 * 3 * 5 * 5 * 7
JOYSTICK_PERIOD = _PARTS * (round(0.05 / _PARTS * 2**57) / 2**57)
"""[s] A joystick is sampled at 20 Hz (paper V-D). 0.05 to 1e-13, and exactly divisible by what rates have in common:
k samples and 3 k ticks of 60 Hz end at the same floating-point time for every k. With 0.05 and 1/60 as they are, two in
five do not, and which of two events comes first would change from tick to tick."""


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
