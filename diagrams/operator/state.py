"""What the simulated person sees and has in mind."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from canal.navigation import NavigationState

EPSILON = 1e-6
"""[s] Slack in comparing sample times."""
NEAR_GOAL = 0.35
"""[m] An item this near the end of the canal hangs at the door; further off it fell elsewhere."""
HAND, EYE = 1, 2
"""Streams of random numbers: errors of the hand, errors of the eye."""


class Mode(IntEnum):
    """What the person is about to do."""

    BEGIN = 0
    """Has not pressed Start yet."""
    PICK = 1
    """Aims above the chosen item and grips it."""
    LIFT = 2
    """Watches whether the item comes along."""
    CARRY = 3
    """Takes the item to its goal and lets go of it."""
    LEAVE = 4
    """Leaves the goal, and judges what became of the item."""
    PUSH = 5
    """Closes the gripper and goes back to push in an item that hangs out."""
    RETREAT = 6
    """Comes back from a push, and opens the gripper."""
    FINISH = 7
    """Has nothing left to do, and presses Stop at home."""


@dataclass(frozen=True)
class Sight:
    """What the person sees at one moment."""

    positions: np.ndarray
    """Middles of the items in B [m]. Shape (n, 3)."""
    placed: np.ndarray
    """Whether each looks placed. Shape (n,)."""
    p_BT: np.ndarray
    """The gripper's centre in B [m]. Shape (3,)."""
    navigation: NavigationState
    """The disk, the point and the path that are drawn on the screen."""


@dataclass
class OperatorState:
    """The person's mind and hand; packed into a vector for the Context."""

    mode: float = float(Mode.BEGIN)
    item: float = -1.0
    """Index of the item that is being handled; -1 for none."""
    busy_until: float = 0.0
    """Time [s] until which the person watches and decides nothing."""
    stick_x: float = 0.0
    stick_y: float = 0.0
    stick_until: float = 0.0
    """The stick is held off centre until then [s]."""
    button: float = 0.0
    """Index of the button that is held; 0 for none."""
    button_until: float = 0.0
    grip_height: float = 0.0
    """Height of the gripper at the grip [m]."""
    aimed: float = 0.0
    """1 once the aim above the item was good."""
    beside: float = 0.0
    """Where on the canal's last disk the item in the hand is to go, if anywhere will do: -1 and 1 for its sides."""

    SIZE = 11
    """Numbers in the vector, without those of each item."""

    @staticmethod
    def unpack(vector: np.ndarray, n: int) -> tuple["OperatorState", np.ndarray, np.ndarray]:
        """The state, which items are given up (n,) and the tries (n,) from a vector of SIZE + 2n.

        Args:
            vector: of SIZE + 2n numbers.
            n: number of items.
        """
        size = OperatorState.SIZE
        return OperatorState(*vector[:size].tolist()), vector[size : size + n].copy(), vector[size + n :].copy()

    def pack(self, given_up: np.ndarray, tries: np.ndarray) -> np.ndarray:
        """Inverse of `unpack`.

        Args:
            given_up: 0 or 1 for each item. Shape (n,).
            tries: so far, for each item. Shape (n,).
        """
        mind = (self.mode, self.item, self.busy_until, self.stick_x, self.stick_y, self.stick_until)
        hand = (self.button, self.button_until, self.grip_height, self.aimed, self.beside)
        return np.concatenate([[*mind, *hand], given_up, tries])
