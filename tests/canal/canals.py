"""Canals that several tests look at, learned once."""

from functools import cache

import numpy as np
from hard_demonstrations import hard_demonstrations

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from canal.surface import CanalSurface


@cache
def hard_canal(seed: int = 3, n: int = 3, shape: str = "pick_and_place") -> CanalSurface:
    return learn_canal(hard_demonstrations(seed, n, shape))


@cache
def elliptic_canal(seed: int = 3, n: int = 4) -> CanalSurface:
    return learn_canal(hard_demonstrations(seed, n), LearningOptions(ellipse=True))


def exact(curves: list, n: int = 400, quaternion=(1.0, 0, 0, 0)) -> list[Demonstration]:
    """Demonstrations of closed-form curves p(u), u in [0, 1], travelled at a constant rate of u."""
    u = np.linspace(0, 1, n)
    orientation = np.tile(np.asarray(quaternion, dtype=float), (n, 1))
    return [
        Demonstration(np.array([curve(v) for v in u]), orientation, name=f"curve {k}") for k, curve in enumerate(curves)
    ]
