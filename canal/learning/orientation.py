"""Mean orientation, its spread, and how much it matters to the robot (paper IV-A and V-C)."""

from __future__ import annotations

import numpy as np

from canal.learning.trimming import continuous_signs
from canal.learning_options import ALPHA, BETA


def mean_orientation(quaternions: np.ndarray) -> np.ndarray:
    """The mean of n rotations at each of N disks: the eigenvector of Σ q qᵀ of the largest eigenvalue.

    Args:
        quaternions: unit, (w, x, y, z). Shape (n, N, 4).

    Returns:
        Unit quaternions, sign-continuous along the disks, the first one near the first demonstration's.
        Shape (N, 4).
    """
    scatter = np.einsum("nsi,nsj->sij", quaternions, quaternions)
    mean = np.linalg.eigh(scatter)[1][:, :, -1]
    mean = continuous_signs(mean)
    return mean if mean[0] @ quaternions[0, 0] >= 0 else -mean


def orientation_spread(quaternions: np.ndarray, mean: np.ndarray) -> np.ndarray:
    """σ_q(s): root mean square of the absolute distance min(|q - q̄|, |q + q̄|) to the mean. Shape (N,).

    Args:
        quaternions: unit, (w, x, y, z), of n demonstrations. Shape (n, N, 4).
        mean: unit. Shape (N, 4).
    """
    apart = np.sum((quaternions - mean) ** 2, axis=2)
    across = np.sum((quaternions + mean) ** 2, axis=2)
    return np.sqrt(np.mean(np.minimum(apart, across), axis=0))


def orientation_weight(spread: np.ndarray, alpha: float = ALPHA, beta: float = BETA) -> np.ndarray:
    """w_o(s) = exp(-α (σ_q(s) - β)), in (0, b ≈ 15]. Shape (N,).

    Args:
        spread: σ_q. Shape (N,).
        alpha: α of the paper's Table I.
        beta: β of the paper's Table I.
    """
    return np.exp(-alpha * (spread - beta))


def agree_in_sign(quaternions: np.ndarray) -> np.ndarray:
    """The same rotations, continuous along each demonstration and in sign with the first one. Shape (n, N, 4)."""
    first = continuous_signs(quaternions[0])
    agreed = [first]
    for other in quaternions[1:]:
        other = continuous_signs(other)
        agreed.append(other if np.sum(other * first) >= 0 else -other)
    return np.stack(agreed)
