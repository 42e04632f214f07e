"""The posture that a run starts from: which of the arm's branches follows the whole canal.

The same tool pose can be held with the shoulder, elbow and wrist turned one way or the other. Within one tick the
inverse kinematics never changes branch, so the choice is made once, for the whole canal.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from canal.errors import InputError
from canal.surface import CanalSurface
from diagrams.ik.solver import IkSolver

# A disk counts as followed within these: 1 mm, and one standard deviation of the demonstrations.
POSITION_TOLERANCE = 1e-3
"""[m] Within this of a disk's centre it counts as reached."""
LEAST_ORIENTATION_TOLERANCE = math.radians(0.1)
"""[rad] The orientation may be off by one standard deviation of the demonstrations, and at least by this."""
_RANDOM_STARTS = 24  # per sampled disk; the Lio has at most 16 branches
_SAMPLED_DISKS = 5
_SETTLE = 12
# Two postures closer than this in every joint are of one branch at one pose.
_SAME = 0.05
_RIM_DISKS, _RIM_SPOKES = 24, 6
# A limit closer than this [rad] is close to being hit when a person corrects.
_COMFORT = 0.1
# A home missed by more than this [m] is no place to start from; by less, the run shows what it can.
_HOME_TOLERANCE = 0.03
_WIDE = 1.0  # [s], a tick that bounds nothing but a jump to another branch


@dataclass(frozen=True, eq=False)
class StartPosture:
    """A branch, and how well it follows the canal's directrix at the weights of the run.

    Attributes:
        q: posture at home, shape (n,) [rad].
        path: posture at each disk, shape (N, n).
        followed: whether each disk is met within 1 mm and one standard deviation of orientation, shape (N,).
        position_error, orientation_error: largest along the directrix [m], [rad].
        limit_margin: smallest distance of any joint to its limit along the directrix [rad].
        limit_joint, limit_disk: where that is.
        rim_share: share of sampled points on the disks' rims that are met.
        largest_step: largest change of a joint from disk to disk [rad]: a change of branch would show here.
        branches: how many branches were compared.
    """

    q: np.ndarray
    path: np.ndarray
    followed: np.ndarray
    position_error: float
    orientation_error: float
    limit_margin: float
    limit_joint: str
    limit_disk: int
    rim_share: float
    largest_step: float
    branches: int

    @property
    def complete(self) -> bool:
        """Whether the whole directrix is followed, with no joint at a limit."""
        return bool(self.followed.all()) and self.limit_margin > 0.0

    def describe(self) -> str:
        """One line for a person."""
        angles = ", ".join(f"{angle:.0f}" for angle in np.degrees(self.q))
        share = f"{100 * float(self.followed.mean()):.0f} %"
        return (
            f"starts at ({angles})°, the best of {self.branches} branches: follows {share} of the directrix "
            f"(worst {1e3 * self.position_error:.2f} mm, {math.degrees(self.orientation_error):.1f}°) and "
            f"{100 * self.rim_share:.0f} % of the rim, {math.degrees(self.limit_margin):.0f}° from the limit of "
            f"{self.limit_joint} at disk {self.limit_disk}"
        )


def orientation_tolerance(canal: CanalSurface) -> np.ndarray:
    """One standard deviation of the demonstrations as an angle [rad], at least 0.1°, at each disk. Shape (N,).

    `orientation_sd` is a distance between quaternions, |q1 - q2| = 2 sin(θ/4).
    """
    angle = 4.0 * np.arcsin(np.minimum(canal.orientation_sd / 2.0, 1.0))
    return np.maximum(angle, LEAST_ORIENTATION_TOLERANCE)


def find_start_posture(
    solver: IkSolver, canal: CanalSurface, *, preferred: np.ndarray | None = None, seed: int = 0
) -> StartPosture:
    """Compare all branches over the whole canal and choose one.

    First counts how much of the directrix is followed, then how much of the rims, then whether limits are more than
    0.1 rad away; among equals the branch nearest to `preferred`, shape (n,), else the one furthest from limits.

    Args:
        solver: of the arm.
        canal: in the robot's base frame.
        preferred: posture to be near to, [rad]. Shape (n,).
        seed: of the postures that are tried.

    Raises:
        InputError: no posture comes near the canal's home.
    """
    branches = [follow(solver, canal, q, rim=False) for q in _postures_at_home(solver, canal, seed)]
    if not branches:
        x, y, z = canal.directrix[canal.home_disk]
        raise InputError(
            f"the canal's home at ({x:.2f}, {y:.2f}, {z:.2f}) m is out of the arm's reach; "
            "demonstrate nearer to the robot's base, or give the canal in its frame"
        )

    def merit(branch: StartPosture) -> tuple[float, ...]:
        near = branch.limit_margin if preferred is None else -float(np.linalg.norm(branch.q - preferred))
        return (
            round(float(branch.followed.mean()), 2),
            round(branch.rim_share, 1),
            min(branch.limit_margin, _COMFORT) > 0.99 * _COMFORT,
            near,
        )

    most = max(float(branch.followed.mean()) for branch in branches)
    contenders = [
        replace(branch, branches=len(branches), rim_share=_rim_share(solver, canal, branch.path))
        for branch in branches
        if branch.followed.mean() >= most - 0.01
    ]
    return max(contenders, key=merit)


def follow(solver: IkSolver, canal: CanalSurface, q_home: np.ndarray, *, rim: bool = True) -> StartPosture:
    """Walk the directrix from home to both ends, disk by disk, at the run's speed and weights.

    Without `rim` the share of the rims is not counted, and is NaN.

    Args:
        solver: of the arm.
        canal: in the robot's base frame.
        q_home: posture at home, [rad]. Shape (n,).
        rim: whether rims are looked at, too.
    """
    n_disks, home = canal.n_disks, canal.home_disk
    dt = canal.moving_time_s / (n_disks - 1)
    path = np.empty((n_disks, solver.n))
    errors = np.empty((n_disks, 2))
    for disks in (range(home, n_disks), range(home, -1, -1)):
        q, v = q_home, np.zeros(solver.n)
        for disk in disks:
            result = solver.solve(canal.pose(disk), float(canal.orientation_weights[disk]), q, dt, v)
            v = (result.q - q) / dt
            q = path[disk] = result.q
            errors[disk] = result.position_error, result.orientation_error
    room = np.minimum(path - solver.q_min, solver.q_max - path)
    lowest, joint = np.unravel_index(int(np.argmin(room)), room.shape)
    return StartPosture(
        q=q_home,
        path=path,
        followed=(errors[:, 0] <= POSITION_TOLERANCE) & (errors[:, 1] <= orientation_tolerance(canal)),
        position_error=float(errors[:, 0].max()),
        orientation_error=float(errors[:, 1].max()),
        limit_margin=float(room.min()),
        limit_joint=solver.kinematics.joint_names[joint],
        limit_disk=int(lowest),
        rim_share=_rim_share(solver, canal, path) if rim else math.nan,
        largest_step=float(np.abs(np.diff(path, axis=0)).max()),
        branches=1,
    )


def _postures_at_home(solver: IkSolver, canal: CanalSurface, seed: int) -> list[np.ndarray]:
    """Postures at home of all branches that random starts find, there and at other disks, from where they walk home."""
    rng = np.random.default_rng(seed)
    home, last = canal.home_disk, canal.n_disks - 1
    found: list[np.ndarray] = []
    disks = [home, *(int(disk) for disk in np.linspace(0, last, _SAMPLED_DISKS) if int(disk) != home)]
    low = np.where(np.isfinite(solver.q_min), solver.q_min, -math.pi)
    high = np.where(np.isfinite(solver.q_max), solver.q_max, math.pi)
    for disk in disks:
        here: list[np.ndarray] = []
        for start in rng.uniform(low, high, size=(_RANDOM_STARTS, solver.n)):
            q = _settle(solver, canal.pose(disk), start, float(canal.orientation_weights[disk]))
            if q is not None:
                _add(here, q)
        way = np.arange(disk, home, 4 if disk < home else -4).tolist() if disk != home else []
        for q in here:
            for stop in [*way, home]:
                q = solver.solve(canal.pose(stop), float(canal.orientation_weights[stop]), q, _WIDE).q
            settled = _settle(solver, canal.pose(home), q, float(canal.orientation_weights[home]))
            if settled is not None:
                _add(found, settled)
    return found


def _add(postures: list[np.ndarray], q: np.ndarray) -> None:
    """Append q unless it is there already."""
    if not any(np.abs(other - q).max() < _SAME for other in postures):
        postures.append(q)


def _settle(solver: IkSolver, pose: np.ndarray, q: np.ndarray, weight: float) -> np.ndarray | None:
    """Rest posture for a fixed pose; None if it is missed by more than 30 mm."""
    for _ in range(_SETTLE):
        result = solver.solve(pose, weight, q, _WIDE)
        moved = float(np.abs(result.q - q).max())
        q = result.q
        if moved < 1e-5:
            break
    return q if result.position_error <= _HOME_TOLERANCE else None


def _rim_share(solver: IkSolver, canal: CanalSurface, path: np.ndarray) -> float:
    """Share of points on the rims of some disks that are met in position, coming from the centre."""
    met = []
    for disk in np.linspace(0, canal.n_disks - 1, _RIM_DISKS).astype(int):
        for phi in np.arange(_RIM_SPOKES) * (2.0 * math.pi / _RIM_SPOKES):
            pose, q = canal.pose(float(disk), 1.0, phi), path[disk]
            for _ in range(2):
                result = solver.solve(pose, float(canal.orientation_weights[disk]), q, _WIDE)
                q = result.q
            met.append(result.position_error <= POSITION_TOLERANCE)
    return float(np.mean(met))
