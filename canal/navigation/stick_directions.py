"""Where a stick's right and up point on each disk of a canal, for somebody who sees it from a given position.

On a disk whose plane holds a direction within 45° of the person's right, the stick's right moves the point within 45°
of it; likewise up. On other disks (seen edge-on from the side, or lying) the plane holds no such direction: there each
axis of the stick goes over from the direction that it has on one side to the one that it has on the other, as slowly as
it can, and up on a lying disk is away from the person. What is found belongs to the disk, not to the way by which it
was reached: forth and back, the same movement of the thumb does the same.

Directions are angles in planes that are carried along the canal without turning; the least sum of costs is found by
dynamic programming, for each axis in turn with the other one fixed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from canal.surface import CanalSurface

HELD = np.sqrt(0.5)
"""A plane holds a direction within 45° of one whose part across the plane is at most this."""
ANGLES = 120
"""Directions that are tried on each disk: every 3°."""
MOST_STEPS = 5
"""Of 3° from disk to disk: with the tilt of the disks and the last correction, less than 20°."""
ROUNDS = 3
"""Times that each axis is found again for the other one's sake."""

ALONG = 1.0
"""Cost of an axis that is at odds with where it should point, times 1 - cos of the angle: where the plane holds it,"""
AWAY = 0.25
"""and for up on a lying disk, where it should point away."""
ASKEW = 1.5
"""Cost of axes that are not across each other, times cos²."""
TURN = 8.0
"""Cost of turning from disk to disk, times the angle² [1/rad²]."""
FORBIDDEN = 1e6
"""Cost of leaving the 45°."""


@dataclass(frozen=True)
class View:
    """How a person sees the robot: unit vectors in its base frame B, right and up across each other.

    Attributes:
        right: of the picture. Shape (3,), or (N, 3) where the view turns along the canal.
        up: likewise.
    """

    right: np.ndarray
    up: np.ndarray
    """Shapes (3,)."""

    @property
    def away(self) -> np.ndarray:
        """Into the picture. As `right`."""
        return np.cross(self.up, self.right)


SEATS = {
    "front": View(np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])),
    "behind": View(np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0])),
    "left": View(np.array([-1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])),
    "right": View(np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])),
}
"""Where a person sits, seen from the robot, which looks along +x: before it and facing it, behind it, at its sides."""


def view_from(right: np.ndarray, up: np.ndarray) -> View:
    """A view from directions that are nearly across each other: up is kept across right.

    Args:
        right: of the picture, in B. Shape (3,).
        up: of the picture, in B. Shape (3,).
    """
    right = np.asarray(right, dtype=float) / np.linalg.norm(right)
    up = up - (up @ right) * right
    return View(right, up / np.linalg.norm(up))


def stick_directions(canal: CanalSurface, view: View) -> np.ndarray:
    """The directions of the stick's right and up on each disk of a canal.

    Args:
        canal: that is travelled.
        view: how the person sees it.

    Returns:
        Unit vectors in the disks' planes, in B. Shape (N, 2, 3).
    """
    e, f = _carried_frames(canal)
    parts = [_parts(e, f, direction) for direction in (view.right, view.up, view.away)]
    costs = [_cost(*parts[0], None), _cost(*parts[1], parts[2])]
    angles = [np.arctan2(part[1], part[0]) for part, _ in parts[:2]]
    for k in range(2 * ROUNDS):
        one, other = (k + 1) % 2, k % 2  # up first: it has a preference where it is not held
        askew = ASKEW * np.cos(GRID[None, :] - angles[other][:, None]) ** 2
        angles[one] = GRID[_cheapest(costs[one] + (askew if k else 0.0))]
    clamped = [_within(angle, *part) for angle, part in zip(angles, parts[:2], strict=True)]
    return np.stack([np.cos(a)[:, None] * e + np.sin(a)[:, None] * f for a in clamped], axis=1)


GRID = np.arange(ANGLES) * 2 * np.pi / ANGLES
"""The directions that are tried, [rad]. Shape (ANGLES,)."""


def _carried_frames(canal: CanalSurface) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors (N, 3) that span each disk's plane, and turn no more than the plane does."""
    e, f = np.empty((canal.n_disks, 3)), np.empty((canal.n_disks, 3))
    e[0], f[0] = canal.x_axes[0], canal.y_axes[0]
    for k in range(1, canal.n_disks):
        normal = np.cross(canal.x_axes[k], canal.y_axes[k])
        normal /= np.linalg.norm(normal)
        before = np.cross(e[k - 1], f[k - 1])
        normal *= 1.0 if normal @ before >= 0 else -1.0
        along = e[k - 1] - (e[k - 1] @ normal) * normal
        if np.linalg.norm(along) < 1e-6:  # a plane across the one before
            along = canal.x_axes[k]
        e[k] = along / np.linalg.norm(along)
        f[k] = np.cross(normal, e[k])
    return e, f


def _parts(e: np.ndarray, f: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A direction's parts in each plane (2, N), and its length in it (N,)."""
    part = np.stack([(e * direction).sum(axis=1), (f * direction).sum(axis=1)])
    return part, np.linalg.norm(part, axis=0)


def _cost(part: np.ndarray, length: np.ndarray, away: tuple[np.ndarray, np.ndarray] | None) -> np.ndarray:
    """What it costs to point an axis at each angle of the grid on each disk. Shape (N, ANGLES)."""
    ahead = part[0][:, None] * np.cos(GRID) + part[1][:, None] * np.sin(GRID)  # cos of the angle to the direction
    held = (length >= HELD)[:, None]
    best = np.maximum(length, HELD)[:, None]
    middle, half = _allowed(part, length)
    off = np.abs((GRID[None, :] - middle[:, None] + np.pi) % (2 * np.pi) - np.pi)
    # The grid may miss a narrow range by half a step; it is put into it at the end.
    cost = ALONG * (best - ahead) + FORBIDDEN * (off > half[:, None] + np.pi / ANGLES + 1e-9)
    free = np.zeros_like(cost)
    if away is not None:
        (u, v), long = away
        free = AWAY * (long[:, None] - (u[:, None] * np.cos(GRID) + v[:, None] * np.sin(GRID)))
    return np.asarray(np.where(held, cost, free))


def _cheapest(cost: np.ndarray) -> np.ndarray:
    """Indices of angles in the grid, disk by disk, with the least sum of costs. Shape (N,)."""
    steps = np.arange(-MOST_STEPS, MOST_STEPS + 1)
    price = TURN * (steps * 2 * np.pi / ANGLES) ** 2
    reached = (np.arange(ANGLES)[None, :] + steps[:, None]) % ANGLES
    total, came = cost[0], np.empty(cost.shape, dtype=int)
    for k in range(1, len(cost)):
        by = total[reached] + price[:, None]
        best = by.argmin(axis=0)
        came[k] = reached[best, np.arange(ANGLES)]
        total = cost[k] + by[best, np.arange(ANGLES)]
    indices = np.empty(len(cost), dtype=int)
    indices[-1] = int(total.argmin())
    for k in range(len(cost) - 1, 0, -1):
        indices[k - 1] = came[k, indices[k]]
    return indices


def _allowed(part: np.ndarray, length: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Middle and half width (N,) of the angles that are within 45° of a direction."""
    half = np.arccos(np.clip(HELD / np.maximum(length, HELD), -1.0, 1.0))
    return np.arctan2(part[1], part[0]), half


def _within(angles: np.ndarray, part: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Angles (N,) put into the 45° where the plane holds them."""
    middle, half = _allowed(part, length)
    off = (angles - middle + np.pi) % (2 * np.pi) - np.pi
    return np.where(length >= HELD, middle + np.clip(off, -half, half), angles)
