"""Canals for the tests of start posture and reach, learned from motions of the arm itself."""

import numpy as np
from ik_arm import pose_of

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from canal.surface import CanalSurface
from diagrams.ik.solver import IkSolver

Q_MIDDLE = np.array([-1.5, -0.2, 1.0, 0.1, 1.4, 0.2])  # reaching forwards, as on the recorded demonstrations
SWING = np.array([1.0, 0.3, 0.2, 0.15, -0.2, 0.3])


def swung_canal(solver: IkSolver, *, lift: float = 0.0, spread: float = 0.03) -> CanalSurface:
    """A canal of two parallel swings of the arm, 2 × `spread` [m] apart, the end lifted by 0.8 × `lift` [m]."""
    demonstrations = []
    for side in (-1.0, 1.0):
        share = np.linspace(-1.0, 1.0, 120)
        poses = np.array([pose_of(solver, Q_MIDDLE + SWING * s) for s in share])
        poses[:, 2] += side * spread + lift * np.clip(share - 0.2, 0.0, None)
        demonstrations.append(Demonstration(poses[:, :3], poses[:, 3:], np.arange(120) / 8.0, f"swing {side:+.0f}"))
    return learn_canal(demonstrations, LearningOptions())
