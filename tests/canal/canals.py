"""Canals that several tests look at, learned once."""

from functools import cache

import numpy as np
from hard_demonstrations import hard_demonstrations

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface

DOCUMENTED = (
    "directrix",
    "radii",
    "tangents",
    "normals",
    "x_axes",
    "y_axes",
    "orientations",
    "orientation_sd",
    "orientation_weights",
    "demonstrations",
    "demonstration_orientations",
)
"""Arrays of a canal that its file documents."""


@cache
def hard_canal(seed: int = 3, n: int = 3, shape: str = "pick_and_place") -> CanalSurface:
    return learn_canal(hard_demonstrations(seed, n, shape))


@cache
def elliptic_canal(seed: int = 3, n: int = 4) -> CanalSurface:
    return learn_canal(hard_demonstrations(seed, n), LearningOptions(ellipse=True))


def arch(side: float, x: float = 0.4) -> Demonstration:
    """Up, over and down again, to one side at both ends and at home, where two of them span a wide disk."""
    t = np.linspace(0, 1, 200)
    position = np.column_stack(
        [x + side * np.cos(4 * np.pi * t), -0.4 * np.cos(np.pi * t), 0.5 + 0.4 * np.sin(np.pi * t)]
    )
    return Demonstration(position, np.tile([1.0, 0, 0, 0], (200, 1)), np.arange(200) / 20.0, f"arch {side}")


@cache
def pinched_canal(half_width: float = 0.1) -> CanalSurface:
    """Wide at pick, home and place, and points in between."""
    return learn_canal([arch(-half_width), arch(half_width)])


@cache
def canal_above_tables() -> CanalSurface:
    """The same beside a table under both ends, and leaning over its edge: disks are clipped."""
    planes = (SupportPlane((0.0, 0.0, 1.0), 0.46), SupportPlane((1.0, 0.0, 0.0), 0.37))
    return learn_canal([arch(-0.1), arch(0.1)], LearningOptions(support_planes=planes))


def exact(curves: list, n: int = 400, quaternion=(1.0, 0, 0, 0)) -> list[Demonstration]:
    """Demonstrations of closed-form curves p(u), u in [0, 1], travelled at a constant rate of u."""
    u = np.linspace(0, 1, n)
    orientation = np.tile(np.asarray(quaternion, dtype=float), (n, 1))
    return [
        Demonstration(np.array([curve(v) for v in u]), orientation, name=f"curve {k}") for k, curve in enumerate(curves)
    ]
