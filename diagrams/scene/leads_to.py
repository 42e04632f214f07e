"""Whether a canal leads to the items of a scenario: asked before anything moves."""

from __future__ import annotations

import math

import numpy as np
from pydrake.math import RigidTransform

from canal.errors import InputError
from canal.surface import CanalSurface
from diagrams.scene.layout import base_pose, draw_layout
from diagrams.scene.world import Drum, World

GRIPPED_AT = 0.04
"""[m] Height of the TCP above a surface at which it closes on what lies there (`fitted_scene.GRIP_HEIGHT`)."""
LOWER, HIGHER = 0.025, 0.030
"""[m] How far off that it may be: lower, the fingertips meet the surface; higher, they close above an apple."""
BESIDE = 0.10
"""[m] Further than this beside the disk the open fingers, 0.055 to each side of the TCP, close on nothing."""


def check_leads_to_items(world: World, canal: CanalSurface, seed: int) -> None:
    """Refuse a canal whose pick disk is not where the items lie, or whose place disk is not where they belong.

    Args:
        world: where items lie and belong.
        canal: in the robot's base frame.
        seed: of the layout.

    Raises:
        InputError: names the first item that is too far off, its distance, and what can be done.
    """
    X_BW = base_pose(world.robot).inverse()
    starts, marks = draw_layout(world, seed)
    last = canal.n_disks - 1
    for item, start, mark in zip(world.items, starts, marks, strict=True):
        _check_surface(canal, 0, f"{item.name} lies", X_BW.multiply(start.position))
        if mark is not None:
            _check_surface(canal, last, f"{item.name} belongs", X_BW.multiply(mark.position))
        elif world.drum is not None:
            distance = _distance_to_drum(X_BW, world.drum, canal.center(last))
            if distance > BESIDE:
                _refuse(canal, last, f"the drum is {distance:.2f} m (at most {BESIDE:.2f}) from the middle of")


def _check_surface(canal: CanalSurface, disk: int, what: str, p_B: np.ndarray) -> None:
    """Refuse a point on a surface (3,) in B that is too far from a disk to grip something there."""
    eta, phi = canal.disk_coordinates(disk, p_B)
    off = p_B + [0.0, 0.0, GRIPPED_AT] - canal.point(disk, min(eta, 1.0), phi)
    beside, below = math.hypot(off[0], off[1]), float(-off[2])
    if beside > BESIDE:
        _refuse(canal, disk, f"{what} {beside:.2f} m beside the reach of (at most {BESIDE:.2f})")
    if not -LOWER <= below <= HIGHER:
        way, most = ("low", HIGHER) if below > 0 else ("high", LOWER)
        _refuse(canal, disk, f"{what} {1e3 * abs(below):.0f} mm (at most {1e3 * most:.0f}) too {way} for")


def _distance_to_drum(X_BW: RigidTransform, drum: Drum, p_B: np.ndarray) -> float:
    """From a point to the nearest point within the drum [m]."""
    inward = X_BW.rotation().multiply(np.asarray(drum.inward, dtype=float))
    offset = p_B - X_BW.multiply(np.asarray(drum.center, dtype=float))
    depth = float(offset @ inward)
    across = float(np.linalg.norm(offset - depth * inward))
    return math.hypot(depth - min(max(depth, 0.0), drum.depth), max(across - drum.radius, 0.0))


def _refuse(canal: CanalSurface, disk: int, what: str) -> None:
    x, y, z = canal.center(disk)
    end = "pick" if disk == 0 else "place"
    raise InputError(
        f"the canal does not lead to the scenario's items: {what} its {end} disk, which is at ({x:.2f}, {y:.2f}, "
        f"{z:.2f}) m with a radius of {canal.radius(disk):.2f} m; move items or retarget the canal in a --scenario "
        "of your own; without --scenario, run_relocation fits its scene to the canal"
    )
