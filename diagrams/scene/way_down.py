"""How the hand comes down on an end of a canal: what open fingers need there, and where they come from."""

from __future__ import annotations

import math

import numpy as np

from canal.surface import CanalSurface
from diagrams.scene.open_gripper import lean, opens_towards
from diagrams.scene.world import Room

HEIGHTS = (0.025, 0.05, 0.075)
"""[m] Of the gripper above where it closes, at which its way is looked at: from 0.067 on, the tips of the open fingers
are above the tallest item, the cup, which stands 0.050 higher than the middle of the gripper."""
FINGERS_ACROSS = 0.060
"""[m] Half a finger's width, the radius of another item, and what a hand errs by."""
TALL = 0.035
"""Of what stands beside the item that is gripped, above the TCP [m]: a gripper that leans comes over it."""
MOST_LEAN = math.radians(50.0)
"""How far off straight down the gripper may point at an end: beyond it the hand comes down on what lies next to it."""
SPOKES = 12
RING = 0.9
"""Points of the disk, at this part of its radius, whose ways are looked at."""


def room_at(canal: CanalSurface, disk: int) -> Room:
    """What the fingers need about an item at the first or the last disk, and how they come down on it; in B.

    Args:
        canal: in the robot's base frame.
        disk: continuous index.
    """
    q = canal.orientations[disk]
    return Room(
        yaw_deg=math.degrees(opens_towards(q)),
        across=FINGERS_ACROSS + TALL * math.tan(min(lean(q), MOST_LEAN)),
        way=_way(canal, disk),
    )


def _way(canal: CanalSurface, end: int) -> list[list[float]]:
    """At each height the plane similarity that turns points of the disk, from its middle, into what the hand is above.

    The point (η, φ) keeps its ratio on its way, so that the disk moves, shrinks and turns as a whole; what tilts or is
    cut by a plane differs a little.
    """
    onwards = np.append(np.arange(end, canal.home_disk, 1 if end < canal.home_disk else -1), canal.home_disk)
    phis = np.arange(SPOKES) * (2 * math.pi / SPOKES)
    ways = np.array([[canal.point(float(k), RING, float(phi)) for k in onwards] for phi in phis]) - canal.directrix[end]
    flat = ways[..., 0] + 1j * ways[..., 1]
    known = np.column_stack([np.ones(SPOKES), flat[:, 0]])
    way = []
    for height in HEIGHTS:
        high = ways[..., 2] >= ways[:, :1, 2] + height
        above = np.where(high.any(axis=1), high.argmax(axis=1), len(onwards) - 1)
        shift, factor = np.linalg.lstsq(known, flat[np.arange(SPOKES), above])[0]
        way.append([float(v) for v in (shift.real, shift.imag, factor.real, factor.imag)])
    return way
