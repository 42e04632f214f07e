"""Travel along a canal (paper IV-C to IV-E, V-D, V-E): `step` moves a `NavigationState` under a joystick vector.

Pure functions of state and input: time comes in as `dt`, and neither a robot nor Drake is known here.
"""

from canal.navigation.joystick import GRIPPER, JOYSTICK_PERIOD, JOYSTICK_SIZE, K_X, K_Y, REVERSE, START, STOP, in_step
from canal.navigation.options import NavigationOptions
from canal.navigation.pressing import GLANCING
from canal.navigation.state import FIELD_NAMES, Ignored, Leg, NavigationState
from canal.navigation.stick_directions import SEATS, View, view_from
from canal.navigation.strategy import leg_end, phase, strategy_ratio
from canal.navigation.tour import Push, segments
from canal.navigation.travel import disks_per_second, initial_state, step

__all__ = [
    "FIELD_NAMES",
    "GLANCING",
    "GRIPPER",
    "JOYSTICK_PERIOD",
    "JOYSTICK_SIZE",
    "K_X",
    "K_Y",
    "REVERSE",
    "SEATS",
    "START",
    "STOP",
    "Ignored",
    "Leg",
    "NavigationOptions",
    "NavigationState",
    "Push",
    "View",
    "disks_per_second",
    "in_step",
    "initial_state",
    "leg_end",
    "phase",
    "segments",
    "step",
    "strategy_ratio",
    "view_from",
]
