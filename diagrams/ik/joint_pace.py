"""How fast a canal can be travelled: a demonstration may have been quicker than the arm's joints are."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from canal.navigation import NavigationOptions
from canal.surface import CanalSurface
from diagrams.ik.solver import IkSolver
from diagrams.ik.start_posture import StartPosture

UNHURRIED = 0.1
"""[m/s] No joint of the Lio comes near its limit when its tool goes along a canal that it reaches at this speed: the
shipped ones are travelled at 0.06 m/s, at which joints turn at a seventh of what they can."""
SHARE = 0.75
"""Of the joints' speed limits that travel may use: where it sets out anew, after a correction, the drives overshoot the
speed that they are told by a quarter (measured: 94°/s of 75)."""
SPOKES, EVERY = 6, 2
"""Directions on the rim, and how many disks apart, in which travel is looked at besides the directrix."""
REACHED = 1e-3
"""[m] A point that is missed by more is none that is travelled through: the arm stops at its reach there."""
_WIDE = 1.0  # [s], a tick that bounds nothing but a jump to another branch


def unhurried(canal: CanalSurface) -> CanalSurface:
    """The canal, travelled at no more than 0.1 m/s: what the arm reaches of it is no question of speed."""
    slow = canal.length / UNHURRIED
    return canal if canal.moving_time_s >= slow else replace(canal, moving_time_s=slow)


def at_joint_pace(
    solver: IkSolver, canal: CanalSurface, start: StartPosture, options: NavigationOptions
) -> tuple[NavigationOptions, str | None]:
    """Navigation at the pace that is wanted, or at what the joints allow where that is less.

    Args:
        solver: with the run's options; it knows the joints' speeds.
        canal: to travel.
        start: posture and path along the directrix.
        options: with the pace that is wanted.

    Returns:
        The options, with `speed_scale` lowered if need be, and a line for a person in that case.
    """
    busiest, joint = busiest_joint(solver, canal, start)
    most = SHARE / busiest
    if options.speed_scale <= most:
        return options, None
    wanted = canal.moving_time_s / options.speed_scale
    name, times = solver.kinematics.joint_names[joint], options.speed_scale * busiest
    line = (
        f"to travel the canal in {wanted:.3g} s would take {times:.1f} times the speed limit of {name}: "
        f"a pass takes {canal.moving_time_s / most:.3g} s"
    )
    return replace(options, speed_scale=most), line


def busiest_joint(solver: IkSolver, canal: CanalSurface, start: StartPosture) -> tuple[float, int]:
    """Which joint is nearest to its speed limit at `speed_scale` 1, on the directrix or along the rim.

    Args:
        solver: with the run's options.
        canal: to travel.
        start: posture and path along the directrix.

    Returns:
        Its largest speed, as a share of its limit, and its index.
    """
    step_s = canal.moving_time_s / (canal.n_disks - 1)
    shares = [np.abs(np.diff(start.path, axis=0)) / (step_s * solver.v_max)]
    for phi in np.arange(SPOKES) * (2.0 * math.pi / SPOKES):
        for direction in (1, -1):
            disks = np.arange(canal.home_disk, canal.n_disks if direction > 0 else -1, direction * EVERY)
            path, reached = _along_rim(solver, canal, start.q, disks, float(phi))
            both = reached[1:] & reached[:-1]
            shares.append(np.abs(np.diff(path, axis=0))[both] / (EVERY * step_s * solver.v_max))
    all_shares = np.concatenate(shares)
    return max(float(all_shares.max()), 1e-9), int(np.unravel_index(np.argmax(all_shares), all_shares.shape)[1])


def _along_rim(
    solver: IkSolver, canal: CanalSurface, q: np.ndarray, disks: np.ndarray, phi: float
) -> tuple[np.ndarray, np.ndarray]:
    """Postures at an angle on the rims of disks, from q at the first (m, n), and whether each is reached (m,)."""
    path, reached = np.empty((len(disks), solver.n)), np.empty(len(disks), dtype=bool)
    for k, disk in enumerate(disks.tolist()):
        for _ in range(3 if k == 0 else 1):
            result = solver.solve(canal.pose(disk, 1.0, phi), canal.weight(disk), q, _WIDE)
            q = result.q
        path[k], reached[k] = q, result.position_error <= REACHED
    return path, reached
