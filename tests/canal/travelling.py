"""What the tests of travelling share: sticks, a canal shaped like an arch, and time that passes."""

import numpy as np

from canal.demonstration import Demonstration
from canal.navigation import step
from canal.navigation.joystick import in_unit_disc

REST = np.zeros(6)
GRIPPER, REVERSE, START, STOP = np.eye(6)[2:]


def stick(k_x: float, k_y: float) -> np.ndarray:
    return np.array([*in_unit_disc(k_x, k_y), 0, 0, 0, 0])


def arch(side: float) -> Demonstration:
    """Up, over and down again, leaning to one side at both ends."""
    t = np.linspace(0, 1, 200)
    position = np.column_stack(
        [0.4 + side * np.cos(2 * np.pi * t), -0.4 * np.cos(np.pi * t), 0.5 + 0.4 * np.sin(np.pi * t)]
    )
    orientation = np.tile([1.0, 0.0, 0.0, 0.0], (200, 1))
    return Demonstration(position, orientation, np.arange(200) / 20.0, f"arch {side}")


def run(canal, state, joystick, seconds, dt=0.01, **kwargs):
    for _ in range(round(seconds / dt)):
        state = step(canal, state, joystick, dt, **kwargs)
    return state
