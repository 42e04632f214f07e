"""The reach report: which share of each disk of a canal the arm reaches, seen before anything moves."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from canal.rows import rows_between
from canal.surface import CanalSurface
from diagrams.ik.solver import IkSolver
from diagrams.ik.start_posture import (
    POSITION_TOLERANCE,
    StartPosture,
    find_start_posture,
    orientation_tolerance,
)

_TICK = 0.25  # [s], long enough that speed bounds nothing between neighbouring points
_ROUNDS = 4
# A colour scale that a colour-blind person can read: out of reach red, half orange, most yellow, and only all of it
# blue (after ColorBrewer's red-yellow-blue, stronger, since the canal is translucent).
_SHARES = (0.0, 0.5, 0.9, 1.0)
_COLORS = np.array([[0.84, 0.15, 0.12], [0.96, 0.45, 0.10], [0.98, 0.76, 0.15], [0.27, 0.46, 0.71]])


@dataclass(frozen=True, eq=False)
class ReachReport:
    """What the arm reaches of a canal, in the branch of its start posture and with the run's weights.

    A point counts when its position is met within 1 mm and its orientation within one standard deviation of the
    demonstrations (at least 0.1°). On each sampled disk the centre and `rings` × `spokes` points are tried.

    Attributes:
        disks: the disks that were sampled, shape (M,).
        etas: ratios of the rings, shape (rings,); each ring stands for an equal part of the disk's area.
        phis: angles of the spokes [rad], shape (spokes,).
        reached: which points count, shape (M, rings, spokes); center_reached: shape (M,).
        postures: at the points [rad], shape (M, rings, spokes, n).
        position_errors: at the points [m], shape (M, rings, spokes).
        orientation_errors: at the points [rad], shape (M, rings, spokes).
        share: part of each disk's area that is reached, in [0, 1], all disks, shape (N,).
        start: the start posture.
    """

    disks: np.ndarray
    etas: np.ndarray
    phis: np.ndarray
    reached: np.ndarray
    center_reached: np.ndarray
    postures: np.ndarray
    position_errors: np.ndarray
    orientation_errors: np.ndarray
    share: np.ndarray
    start: StartPosture

    def colors(self) -> np.ndarray:
        """Red, green and blue in [0, 1] for each disk, from red (out of reach) to blue (all of it), shape (N, 3)."""
        return rows_between(_COLORS, self.share, np.array(_SHARES))

    def describe(self) -> list[str]:
        """Lines for a person: how much is reached, and from where to where it is not."""
        lines = [
            self.start.describe(),
            f"the arm reaches {100 * float(self.share.mean()):.0f} % of the canal: "
            f"all of {int((self.share >= 1.0).sum())} of {len(self.share)} disks, "
            f"the centre of {100 * float(self.center_reached.mean()):.0f} %",
        ]
        for first, last in _runs(self.share < 0.5):
            worst = float(self.position_errors[(self.disks >= first) & (self.disks <= last)].max(initial=0.0))
            lines.append(f"disks {first} to {last}: less than half is reached, missed by up to {1e3 * worst:.0f} mm")
        return lines


def reach_report(
    solver: IkSolver,
    canal: CanalSurface,
    start: StartPosture | None = None,
    *,
    rings: int = 3,
    spokes: int = 12,
    most_disks: int = 201,
    progress: Callable[[int, int], None] | None = None,
) -> ReachReport:
    """Try points on the disks of a canal, each from its neighbour towards the centre.

    Args:
        solver: with the options of the run.
        canal: in the solver's base frame.
        start: of the run; chosen here when not given.
        rings: how many rings of points on a disk, beside its centre.
        spokes: how many points on each ring.
        most_disks: how many disks are sampled; those between get what their neighbours have.
        progress: called with how many disks are done, of how many.

    Raises:
        InputError: no posture comes near the canal's home.
    """
    start = find_start_posture(solver, canal) if start is None else start
    n_disks = canal.n_disks
    disks = np.unique(np.linspace(0, n_disks - 1, min(n_disks, most_disks)).round().astype(int))
    # The outermost is the rim; the others halve the area of their annuli.
    etas = np.append(np.sqrt((np.arange(rings - 1) + 0.5) / rings), 1.0)
    phis = np.arange(spokes) * (2.0 * math.pi / spokes)
    tolerance = orientation_tolerance(canal)
    errors = np.empty((len(disks), rings, spokes, 2))
    postures = np.empty((len(disks), rings, spokes, solver.n))
    center_reached = np.empty(len(disks), dtype=bool)
    for row, disk in enumerate(disks.tolist()):
        limit, weight = float(tolerance[disk]), float(canal.orientation_weights[disk])
        q_center, *center = _reach(solver, canal.pose(disk), weight, start.path[disk], limit)
        center_reached[row] = _counts(np.array(center), limit)
        for spoke, phi in enumerate(phis):
            q = q_center
            for ring, eta in enumerate(etas):
                pose = canal.pose(disk, float(eta), float(phi))
                q, *errors[row, ring, spoke] = _reach(solver, pose, weight, q, limit)
                postures[row, ring, spoke] = q
        if progress is not None:
            progress(row + 1, len(disks))
    reached = _counts(errors, tolerance[disks, None, None])
    return ReachReport(
        disks=disks,
        etas=etas,
        phis=phis,
        reached=reached,
        center_reached=center_reached,
        postures=postures,
        position_errors=errors[..., 0],
        orientation_errors=errors[..., 1],
        share=np.interp(np.arange(n_disks), disks, reached.mean(axis=(1, 2))),
        start=start,
    )


def _reach(
    solver: IkSolver, pose: np.ndarray, weight: float, q: np.ndarray, limit: float
) -> tuple[np.ndarray, float, float]:
    """Posture and errors [m], [rad] after a few ticks, fewer when it is met."""
    for _ in range(_ROUNDS):
        result = solver.solve(pose, weight, q, _TICK)
        q = result.q
        if result.position_error <= POSITION_TOLERANCE and result.orientation_error <= limit:
            break
    return q, result.position_error, result.orientation_error


def _counts(errors: np.ndarray, limit: np.ndarray | float) -> np.ndarray:
    """Whether errors (..., 2) [m], [rad] are within 1 mm and the limit [rad]."""
    return (errors[..., 0] <= POSITION_TOLERANCE) & (errors[..., 1] <= limit)


def _runs(flags: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(int), [0]))))
    return [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
