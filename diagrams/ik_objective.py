"""The objective of one tick with its exact gradient and Hessian.

    f(q) = w_p |p(q) - p*|² + Σ w_i φ_i² + Σ ((q - q_prev) / range)²          (SPEC 5; the paper's eq. for J(s))

φ is the logarithm of the rotation from the wanted to the actual orientation. For a chain of one-degree joints with
Jacobian columns (a_j, v_j), ∂a_j/∂q_i = a_i × a_j and ∂v_j/∂q_i = a_i × v_j for i before j, so the second derivatives
cost nothing but one more small product:

    ∇f  = 2 (Jᵀ [u; w_p e] + D (q - q_prev)),   e = p - p*,  D = 1/range²
    ∇²f = 2 (Jᵀ diag(S, w_p I) J + D + C),      C_ij = a_i · (½ a_j × u + w_p v_j × e) for i ≤ j, symmetric

with u and S from `diagrams.ik_rotation`.
"""

import math

import numpy as np

from diagrams.ik_kinematics import ArmKinematics
from diagrams.ik_rotation import axis_weight_derivatives, equal_weight_derivatives, rotation_log

# A joint without limits is scaled as if it turned once.
_RANGE_WITHOUT_LIMITS = 2.0 * math.pi


class PoseObjective:
    """f and its derivatives; set the tick with `set_target`, then `value` and, at the same q, `derivatives`.

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
        n = kinematics.n
        self._upper = np.triu(np.ones((n, n)), 1) + 0.5 * np.eye(n)

    def set_target(self, p: np.ndarray, R: np.ndarray, weights: tuple[float, float, float], q_prev: np.ndarray) -> None:
        """Wanted position p (3,) [m] and rotation R (3, 3) in B, weights about the tool's axes, last posture (n,)."""
        self._target_transposed = R.T
        self._px, self._py, self._pz = p.tolist()
        self._weights, self._equal = weights, weights[0] == weights[1] == weights[2]
        self._q_prev = q_prev

    def value(self, q: np.ndarray) -> float:
        """f(q), with q finite."""
        arm = self.kinematics
        arm.set(q)
        pose = arm.pose()
        R = pose[:, :3]
        x, y, z = pose[:, 3].tolist()
        ex, ey, ez = x - self._px, y - self._py, z - self._pz
        square = ex * ex + ey * ey + ez * ez
        if self._equal:
            error = R.dot(self._target_transposed)  # in B
        else:
            error = self._target_transposed.dot(R)  # in T
            self._R = R
        phi = fx, fy, fz = rotation_log(error.tolist())
        w = self._weights
        self._delta = delta = q - self._q_prev
        self._e, self._phi = (ex, ey, ez), phi
        self._square = square
        self._jacobian: np.ndarray | None = None
        return (
            self.position_weight * square
            + w[0] * fx * fx
            + w[1] * fy * fy
            + w[2] * fz * fz
            + float((delta * delta).dot(self._d))
        )

    @property
    def position_error(self) -> float:
        """|p - p*| [m] where `value` was last called."""
        return math.sqrt(self._square)

    @property
    def orientation_error(self) -> float:
        """The angle θ [rad] where `value` was last called; about the weighted axes of the tool only."""
        if self._equal:
            return math.hypot(*self._phi)
        return math.hypot(*(f for f, w in zip(self._phi, self._weights, strict=True) if w > 0.0))

    def gradient(self) -> np.ndarray:
        """Gradient (n,) where `value` was last called: a third of the price of all `derivatives`."""
        J = self._jacobian = self.kinematics.jacobian()
        wp = self.position_weight
        ex, ey, ez = self._e
        if self._equal:
            w = self._weights[0]
            ux, uy, uz = self._phi
            ux, uy, uz = w * ux, w * uy, w * uz
        else:
            ux, uy, uz = self._R.dot(axis_weight_derivatives(self._phi, self._weights)[0]).tolist()
        gradient = J.T.dot((ux, uy, uz, wp * ex, wp * ey, wp * ez)) + self._d * self._delta
        gradient *= 2.0
        return gradient

    def derivatives(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Gradient (n,), Hessian (n, n) and the second-order part in it (n, n), where `value` was last called."""
        J = self.kinematics.jacobian() if self._jacobian is None else self._jacobian
        wp = self.position_weight
        ex, ey, ez = self._e
        ex, ey, ez = wp * ex, wp * ey, wp * ez
        if self._equal:
            (ux, uy, uz), (s0, s1, s2) = equal_weight_derivatives(self._phi, self._weights[0])
        else:
            u_T, S_T = axis_weight_derivatives(self._phi, self._weights)
            ux, uy, uz = self._R.dot(u_T).tolist()
            s0, s1, s2 = self._R.dot(S_T).dot(self._R.T).tolist()
        hx, hy, hz = 0.5 * ux, 0.5 * uy, 0.5 * uz
        # Rows: diag(S, w_p I), then [-½[u] | -w_p[e]], then (u, w_p e).
        blocks = np.array(
            (
                (*s0, 0.0, 0.0, 0.0),
                (*s1, 0.0, 0.0, 0.0),
                (*s2, 0.0, 0.0, 0.0),
                (0.0, 0.0, 0.0, wp, 0.0, 0.0),
                (0.0, 0.0, 0.0, 0.0, wp, 0.0),
                (0.0, 0.0, 0.0, 0.0, 0.0, wp),
                (0.0, hz, -hy, 0.0, ez, -ey),
                (-hz, 0.0, hx, -ez, 0.0, ex),
                (hy, -hx, 0.0, ey, -ex, 0.0),
                (ux, uy, uz, ex, ey, ez),
            )
        ).dot(J)
        curvature = J[:3].T.dot(blocks[6:9])
        curvature *= self._upper
        curvature = curvature + curvature.T
        hessian = J.T.dot(blocks[:6])
        hessian += self._d_matrix
        hessian += curvature
        gradient = blocks[9] + self._d * self._delta
        gradient *= 2.0
        hessian *= 2.0
        curvature *= 2.0
        return gradient, hessian, curvature
