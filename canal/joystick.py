"""The joystick vector (paper V-D): two axes, four buttons, sampled at 20 Hz."""

JOYSTICK_SIZE = 6
"""Joystick vector: k_x, k_y in [-1, 1], then the levels (0 or 1) of the buttons gripper, reverse, start, stop."""
K_X, K_Y, GRIPPER, REVERSE, START, STOP = range(JOYSTICK_SIZE)
"""Places in it: the stick along the disk's correction axes x and y, then the buttons."""
JOYSTICK_PERIOD = 0.05
"""[s] A joystick is sampled at 20 Hz (paper V-D)."""
