"""What the inverse kinematics is tried on: recorded paths, and the worst of targets."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from canal.demonstration import load_demonstration
from diagrams.ik.solver import IkSolver
from diagrams.station.lio_station import START_POSTURE
from models import MODELS

DT = 0.01
WEIGHTS = (0.1, 1.0, 15.0)
# Recordings of the real robot, when they lie beside the project.
RECORDED = Path(__file__).parents[3] / "shared" / "demos"
_SAMPLE_RATE = 20.0
_RANDOM_STARTS = 30


def pose_of(solver: IkSolver, q: np.ndarray) -> np.ndarray:
    """Position [m] and quaternion (w, x, y, z) of the tool at posture q (n,). Shape (7,)."""
    solver.kinematics.set(q)
    pose = solver.kinematics.pose()
    return np.concatenate((pose[:, 3], Rotation.from_matrix(pose[:, :3]).as_quat(scalar_first=True)))


@dataclass(frozen=True)
class Case:
    """A path of wanted poses (T, 7) at 100 Hz, the weight of orientation, and where the arm starts, shape (n,)."""

    name: str
    poses: np.ndarray
    weight: float
    q_start: np.ndarray


def demonstration_cases(solver: IkSolver) -> Iterator[Case]:
    """Every shipped and recorded demonstration at every weight, from the branch that follows its first pose best."""
    files = [*sorted((MODELS / "demonstrations").glob("*.npz")), *sorted(RECORDED.glob("*.npz"))]
    for file in files:
        demonstration = load_demonstration(file)
        poses = densify(demonstration.position, demonstration.orientation)
        q_start = best_start(solver, poses)
        for weight in WEIGHTS:
            yield Case(f"{file.stem} w={weight:g}", poses, weight, q_start)


def densify(position: np.ndarray, orientation: np.ndarray) -> np.ndarray:
    """Samples at 20 Hz to pose vectors at 100 Hz."""
    times = np.arange(len(position)) / _SAMPLE_RATE
    fine = np.arange(0.0, times[-1], DT)
    turn = Slerp(times, Rotation.from_quat(orientation, scalar_first=True))(fine)
    points = np.column_stack([np.interp(fine, times, column) for column in position.T])
    return np.hstack([points, turn.as_quat(scalar_first=True)])


def best_start(solver: IkSolver, poses: np.ndarray) -> np.ndarray:
    """Of random postures that settle at the first pose, the one from which the path is followed best."""
    rng = np.random.default_rng(0)
    best, q_best = np.inf, START_POSTURE
    for q in rng.uniform(solver.q_min, solver.q_max, size=(_RANDOM_STARTS, solver.n)):
        for _ in range(6):
            q = solver.solve(poses[0], 15.0, q, 1.0).q
        q_first, worst = q, 0.0
        for pose in poses[::10]:
            result = solver.solve(pose, 15.0, q, 10 * DT)
            q, worst = result.q, max(worst, result.position_error + 0.1 * result.orientation_error)
            if worst >= best:
                break
        if worst < best:
            best, q_best = worst, q_first
    return q_best


def adversarial_cases(solver: IkSolver) -> Iterator[Case]:
    """Targets out of reach, singular, spinning and jumping, and starts at and beyond the limits."""
    ticks, rng = 400, np.random.default_rng(1)
    down = np.array([0.0, 1.0, 0.0, 0.0])

    def spin(share: float) -> np.ndarray:
        return Rotation.from_euler("y", 360.0 * share, degrees=True).as_quat(scalar_first=True)

    def still(p: list[float], quaternion: np.ndarray) -> np.ndarray:
        return np.tile(np.concatenate((p, quaternion)), (ticks, 1))

    front = [0.17, 0.0, 1.05]
    jumps = [np.concatenate((rng.normal(scale=0.5, size=3), rng.normal(size=4))) for _ in range(16)]
    paths = {
        "2 m out of reach": still([0.0, 3.0, 1.0], down),
        "straight up": still([0.0, 0.0, 1.7], np.array([0.0, 1.0, 1.0, 0.0])),
        "straight down": still([0.001, 0.001, 0.1], down),
        "through the axis of joint 1": np.array([[0.3 - 0.0015 * k, 0.0, 1.0, *down] for k in range(ticks)]),
        "360° spin": np.array([[*front, *spin(k / ticks)] for k in range(ticks)]),
        "180° jumps": np.array([[*front, *spin(0.5 * (k // 40))] for k in range(ticks)]),
        "random jumps": np.array([jumps[k // 25] for k in range(ticks)]),
    }
    starts = {"": START_POSTURE, ", stretched": np.zeros(6), ", beyond limits": solver.q_max + 0.3}
    for name, poses in paths.items():
        for suffix, q_start in starts.items():
            yield Case(f"adversarial: {name}{suffix}", poses, 1.0, q_start)
