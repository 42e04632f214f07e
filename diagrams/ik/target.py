"""What a tick is asked for, read from whatever comes: usable and bounded values, or none."""

import math

import numpy as np

# A target further off than this [m] pulls in the same direction, and its square stays finite.
_FAR = 1e3
_LEAST_QUATERNION = 1e-6
_HEAVIEST = 1e9  # an orientation weight above this is as good as infinite


def all_finite(values: np.ndarray) -> bool:
    """Whether all entries are finite and small enough for their arithmetic to stay so."""
    return all(-1e9 < value < 1e9 for value in values.tolist())


def wanted_pose(X: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Position (3,) and rotation (3, 3) of a pose vector (7,); None if it has no usable value."""
    values = np.asarray(X, dtype=float).ravel().tolist()
    if len(values) != 7 or not all(map(math.isfinite, values)):
        return None
    x, y, z, qw, qx, qy, qz = values
    length = math.hypot(qw, qx, qy, qz)
    if not _LEAST_QUATERNION < length < 1.0 / _LEAST_QUATERNION:
        return None
    qw, qx, qy, qz = qw / length, qx / length, qy / length, qz / length
    p = np.array((x, y, z))
    distance = math.hypot(x, y, z)
    if distance > _FAR:
        p = p / distance * _FAR
    xx, yy, zz = 2.0 * qx * qx, 2.0 * qy * qy, 2.0 * qz * qz
    xy, xz, yz = 2.0 * qx * qy, 2.0 * qx * qz, 2.0 * qy * qz
    wx, wy, wz = 2.0 * qw * qx, 2.0 * qw * qy, 2.0 * qw * qz
    R = np.array(
        ((1.0 - yy - zz, xy - wz, xz + wy), (xy + wz, 1.0 - xx - zz, yz - wx), (xz - wy, yz + wx, 1.0 - xx - yy))
    )
    return p, R


def wanted_weight(w_o: float | np.ndarray) -> float | None:
    """A weight from 0 to the heaviest; None if it is not one finite number."""
    values = [w_o] if isinstance(w_o, float) else np.asarray(w_o, dtype=float).ravel().tolist()
    return min(max(values[0], 0.0), _HEAVIEST) if len(values) == 1 and math.isfinite(values[0]) else None
