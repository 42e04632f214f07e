"""The objective of one tick, as a sum of squares with its exact gradient and its Gauss-Newton matrix.

    f(q) = w_p |p(q) - p*|² + w_o θ(q)² + Σ ((q - q_prev) / range)²          (the paper's J(s), V-C)

With φ the logarithm of the rotation from the wanted to the actual orientation, θ = |φ|, the residual
r = (√w_o φ, √w_p (p - p*)) has the Jacobian K = diag(√w_o J_l⁻¹(φ), √w_p I) J, with J the tool's own (rows ω, v), so

    ∇f  = 2 (Kᵀ r + D (q - q_prev)) = 2 (Jᵀ (w_o φ, w_p (p - p*)) + D (q - q_prev)),    D = diag(1/range²)
    ∇²f ≈ 2 (Kᵀ K + D),

the second because φᵀ J_l⁻¹ = φᵀ, and the third without the terms that vanish with r: convex, whatever the posture.
"""

import math

import numpy as np

from diagrams.ik.kinematics import ArmKinematics
from diagrams.ik.rotation import inverse_left_jacobian, rotation_log

# A joint without limits is scaled as if it turned once.
_RANGE_WITHOUT_LIMITS = 2.0 * math.pi


class PoseObjective:
    """f and its derivatives; set the tick with `set_target`, then `value` and, at the same q, what follows from it.

    Attributes (after `value`):
        position_error: |p - p*| [m]; orientation_error: θ [rad].
    """

    def __init__(self, kinematics: ArmKinematics, position_weight: float) -> None:
        self.kinematics = kinematics
        self.position_weight = position_weight
        span = kinematics.q_max - kinematics.q_min
        span = np.where(np.isfinite(span) & (span > 0.0), span, _RANGE_WITHOUT_LIMITS)
        self._d = 1.0 / span**2
        self._d_matrix = np.diag(self._d)
        self._root_p = math.sqrt(position_weight)

    def set_target(self, p: np.ndarray, R: np.ndarray, weight: float, q_prev: np.ndarray) -> None:
        """Wanted position p (3,) [m] and rotation R (3, 3) in B, weight of orientation w_o ≥ 0, last posture (n,).

        Args:
            p: in B, [m]. Shape (3,).
            R: in B. Shape (3, 3).
            weight: w_o ≥ 0 of orientation.
            q_prev: the last posture, [rad]. Shape (n,).
        """
        self._target_transposed = R.T
        self._px, self._py, self._pz = p.tolist()
        self._weight, self._root_o = weight, math.sqrt(weight)
        self._q_prev = q_prev

    def value(self, q: np.ndarray) -> float:
        """f(q), with q finite."""
        arm = self.kinematics
        arm.set(q)
        pose = arm.pose()
        x, y, z = pose[:, 3].tolist()
        self._e = ex, ey, ez = x - self._px, y - self._py, z - self._pz
        self._phi = fx, fy, fz = rotation_log(pose[:, :3].dot(self._target_transposed).tolist())
        self._square, self._angle_square = ex * ex + ey * ey + ez * ez, fx * fx + fy * fy + fz * fz
        self._delta = delta = q - self._q_prev
        self._jacobian: np.ndarray | None = None
        regular = float((delta * delta).dot(self._d))
        return self.position_weight * self._square + self._weight * self._angle_square + regular

    @property
    def position_error(self) -> float:
        """|p - p*| [m] where `value` was last called."""
        return math.sqrt(self._square)

    @property
    def orientation_error(self) -> float:
        """The angle θ [rad] where `value` was last called."""
        return math.sqrt(self._angle_square)

    def gradient(self) -> np.ndarray:
        """∇f (n,) where `value` was last called."""
        if self._jacobian is None:
            self._jacobian = self.kinematics.jacobian()
        wp, wo = self.position_weight, self._weight
        (ex, ey, ez), (fx, fy, fz) = self._e, self._phi
        gradient = self._jacobian.T.dot((wo * fx, wo * fy, wo * fz, wp * ex, wp * ey, wp * ez))
        gradient += self._d * self._delta
        gradient *= 2.0
        return gradient

    def model(self) -> tuple[np.ndarray, np.ndarray]:
        """∇f (n,) and the positive definite 2 (KᵀK + D) (n, n) where `value` was last called."""
        gradient = self.gradient()
        assert self._jacobian is not None
        r = self._root_p
        a, b, c = inverse_left_jacobian(self._phi, self._root_o)
        K = np.array(
            (
                (*a, 0.0, 0.0, 0.0),
                (*b, 0.0, 0.0, 0.0),
                (*c, 0.0, 0.0, 0.0),
                (0.0, 0.0, 0.0, r, 0.0, 0.0),
                (0.0, 0.0, 0.0, 0.0, r, 0.0),
                (0.0, 0.0, 0.0, 0.0, 0.0, r),
            )
        ).dot(self._jacobian)
        hessian = K.T.dot(K)
        hessian += self._d_matrix
        hessian *= 2.0
        return gradient, hessian
