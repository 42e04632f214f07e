"""Poses as vectors of 7 numbers: position [m], unit quaternion w, x, y, z."""

from __future__ import annotations

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform


def pose_to_vector(X: RigidTransform) -> np.ndarray:
    """Position and quaternion. Shape (7,)."""
    return np.concatenate((X.translation(), X.rotation().ToQuaternion().wxyz()))


def vector_to_pose(vector: np.ndarray) -> RigidTransform:
    """The pose of a position and a quaternion, made unit. Input of shape (7,)."""
    q = np.asarray(vector[3:], dtype=float)
    return RigidTransform(Quaternion(q / np.linalg.norm(q)), vector[:3])
