"""What "placed" means (docs/method.md, 7): one goal an item, judged alike by the monitor and by an operator's eye."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np


class Goal(Protocol):
    """Where an item belongs. Poses are vectors (position, quaternion w x y z), bounds (min, max), both in W."""

    @property
    def position(self) -> np.ndarray:
        """Where a person would look: the point in W [m] that the item is brought to. Shape (3,)."""
        ...

    @property
    def precise(self) -> bool:
        """Whether the item must come to `position` itself, or just be inside."""
        ...

    def placed(self, pose: np.ndarray, bounds: np.ndarray) -> bool:
        """Whether an item with this pose (7,) and these bounds (6,) is where it belongs; rest is judged elsewhere.

        Args:
            pose: position [m] and quaternion (w, x, y, z) in W. Shape (7,).
            bounds: least corner, then largest, in W [m]. Shape (6,).
        """
        ...


BACK_WALL = 0.03
"""Thickness of the drum's back [m]: nothing gets past it, so that what leans on it, seen a little wrong, is inside."""


@dataclass(frozen=True)
class DrumGoal:
    """Inside a front-loading drum: the whole shape behind the door's plane and within the drum."""

    p_WD: np.ndarray
    """Centre of the door's plane in W [m]. Shape (3,)."""
    inward: np.ndarray
    """Unit vector along the drum's axis, into the machine, in W; along an axis of W. Shape (3,)."""
    depth: float
    """Depth of the drum behind the door's plane [m]."""
    radius: float
    """Radius of the drum [m]."""
    clearance: float = 0.01
    """What a shape may reach past the ideal cylinder [m]: contact is compliant."""

    @property
    def position(self) -> np.ndarray:
        """The middle of the drum."""
        return self.p_WD + 0.5 * self.depth * self.inward

    @property
    def precise(self) -> bool:
        """Anywhere in the drum will do."""
        return False

    def placed(self, pose: np.ndarray, bounds: np.ndarray) -> bool:
        """The bounds lie behind the door's plane, and their middle in the cylinder of the drum.

        Args:
            pose: position [m] and quaternion (w, x, y, z) in W. Shape (7,).
            bounds: least corner, then largest, in W [m]. Shape (6,).
        """
        p, n = self.p_WD.tolist(), self.inward.tolist()
        low = [b - o for b, o in zip(bounds[:3].tolist(), p, strict=True)]
        high = [b - o for b, o in zip(bounds[3:].tolist(), p, strict=True)]
        first, last = sorted((math.sumprod(low, n), math.sumprod(high, n)))
        across = [(a + b) / 2 - (first + last) / 2 * c for a, b, c in zip(low, high, n, strict=True)]
        return (
            first >= -self.clearance
            and last <= self.depth + self.clearance + BACK_WALL
            and math.hypot(*across) <= self.radius
        )


@dataclass(frozen=True)
class MarkGoal:
    """At rest on a marked spot of a table."""

    position: np.ndarray
    """Where the item's origin is when it stands on the mark, in W [m]. Shape (3,)."""
    tolerance: float = 0.03
    """Horizontal distance that is still on the mark [m] (docs/method.md, 7)."""
    height_tolerance: float = 0.03
    """Vertical distance [m]: it stands on the table, neither on the floor nor on something else."""
    upright: bool = False
    """Whether its z axis must point up (the cup)."""

    @property
    def precise(self) -> bool:
        """The mark is the place."""
        return True

    def placed(self, pose: np.ndarray, bounds: np.ndarray) -> bool:
        """Within the tolerances of the mark, upright where asked.

        Args:
            pose: position [m] and quaternion (w, x, y, z) in W. Shape (7,).
            bounds: least corner, then largest, in W [m]. Shape (6,).
        """
        error = pose[:3] - self.position
        w, x, y, _z = pose[3:]
        # z component of the body's z axis in W: 1 - 2 (x² + y²), for a unit quaternion.
        leans = self.upright and 1 - 2 * (x * x + y * y) / (w * w + x * x + y * y + _z * _z) < COS_UPRIGHT
        return bool(
            np.hypot(error[0], error[1]) <= self.tolerance and abs(error[2]) <= self.height_tolerance and not leans
        )


COS_UPRIGHT = np.cos(np.deg2rad(15.0))
"""A cup that leans by more than 15° is about to spill: not upright."""
