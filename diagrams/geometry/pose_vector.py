"""Poses as vectors of 7 numbers: position [m], unit quaternion w, x, y, z."""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform


def pose_to_vector(X: RigidTransform) -> np.ndarray:
    """Position and quaternion. Shape (7,)."""
    return np.concatenate((X.translation(), X.rotation().ToQuaternion().wxyz()))
