"""Where one is on a canal: the legs of the cycle, and the state of navigation as a vector (paper V-E)."""

from dataclasses import dataclass, fields
from enum import IntEnum
from operator import attrgetter

import numpy as np


class Ignored(IntEnum):
    """Why a press did nothing."""

    NOTHING = 0
    """No press has been ignored yet."""
    STOPPED = 1
    """Nothing moves until start."""
    ALREADY_STOPPED = 2
    """Stop, while nothing moves anyhow."""
    STOP_HELD = 3
    """Start, while stop is held."""
    WAITING = 4
    """Start, at pick or place: a grip, a release or a reversal goes on."""
    PRESSING = 5
    """Start, while the robot presses on something."""
    POINT = 6
    """The stick, where the canal is as narrow as a point."""


class Leg(IntEnum):
    """The four legs of the cycle, in order (paper V-E)."""

    HOME_TO_PICK = 0
    PICK_TO_HOME = 1
    HOME_TO_PLACE = 2
    PLACE_TO_HOME = 3
    """0 and 2 lead outwards, where a correction is kept; 1 and 3 homewards, where it fades."""

    @property
    def direction(self) -> int:
        """+1 where the disk index grows, -1 where it falls."""
        return 1 if self in (Leg.PICK_TO_HOME, Leg.HOME_TO_PLACE) else -1

    @property
    def homeward(self) -> bool:
        """Whether the leg ends at home, and so converges (paper V-E)."""
        return self in (Leg.PICK_TO_HOME, Leg.PLACE_TO_HOME)

    @property
    def reversed(self) -> "Leg":
        """The same half of the canal the other way (backtracking, paper IV-E)."""
        return Leg(self ^ 1)

    @property
    def next(self) -> "Leg":
        """The leg that follows in the cycle."""
        return Leg((self + 1) % 4)


@dataclass(slots=True, frozen=True)
class NavigationState:
    """Where we are and what has been counted; floats throughout, so that it lives in a Drake context as a vector."""

    disk: float
    """Continuous disk index in [0, N_f - 1]; 0 is pick, the middle home, the last place."""
    eta: float = 0.0
    """Ratio η of the distance from the disk's centre to its radius, in [0, 1]."""
    phi: float = 0.0
    """Angle φ [rad] of the point on the disk, from x_s towards y_s."""
    leg: float = float(Leg.HOME_TO_PICK)
    """The `Leg` that is being travelled."""
    anchor_disk: float = 0.0
    """Disk where the ratio strategy last started: the leg's start, or where the last correction ended."""
    anchor_eta: float = 0.0
    """η_0, the ratio at the anchor."""
    running: float = 0.0
    """1 after start, 0 after stop."""
    gripper_closed: float = 0.0
    """1 when the gripper is told to close."""
    pause_s: float = -1.0
    """Time since the gripper button; negative when no pause is on."""
    correcting: float = 0.0
    """1 while the stick moves the point on the disk."""
    waiting: float = 0.0
    """1 while standing at pick or place for the operator."""
    paused: float = 0.0
    """1 while start holds the robot on its disk, until start is pressed again."""
    held_gripper: float = 0.0
    """Level of the gripper button at the last step (for its edge); likewise the next three."""
    held_reverse: float = 0.0
    """See `held_gripper`."""
    held_start: float = 0.0
    """See `held_gripper`."""
    held_stop: float = 0.0
    """See `held_gripper`."""
    held_stick: float = 0.0
    """1 while the stick was off centre at the last step."""
    alarm: float = 0.0
    """1 while a contact force is above its limit."""
    press_x: float = 0.0
    """The direction that presses while it is, a unit vector in the robot's base frame; zero where none is known."""
    press_y: float = 0.0
    """See `press_x`."""
    press_z: float = 0.0
    """See `press_x`."""
    press_way: float = 0.0
    """The way along the canal that pressed when the force rose: +1, -1, or 0 where it was not the travel."""
    travelled: float = 0.0
    """The way that was travelled last: +1 towards place, -1 towards pick, 0 before the first travel."""
    blocked: float = 0.0
    """1 while a motion that is wanted is held back, or cut, because it presses."""
    ignored: float = 0.0
    """Presses so far that did nothing."""
    ignored_why: float = 0.0
    """The reason of the last of them, an `Ignored`."""
    corrections: float = 0.0
    """Corrections so far: times that the stick left its centre."""
    backtracks: float = 0.0
    """Reversals so far."""
    correction_time_s: float = 0.0
    """Time spent correcting [s]."""
    correction_distance_m: float = 0.0
    """Length of the way that corrections commanded on the disks [m]."""

    def to_vector(self) -> np.ndarray:
        """All fields in order. Shape (len(fields),)."""
        return np.array(_ALL_FIELDS(self))

    @staticmethod
    def from_vector(vector: np.ndarray) -> "NavigationState":
        """Inverse of `to_vector`."""
        return NavigationState(*np.asarray(vector, dtype=float).tolist())


FIELD_NAMES: tuple[str, ...] = tuple(f.name for f in fields(NavigationState))
"""Names of the components of the state vector, in order."""
_ALL_FIELDS = attrgetter(*FIELD_NAMES)
