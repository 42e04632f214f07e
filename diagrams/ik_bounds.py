"""What one tick may do to the joints: limits of position, speed and, if asked for, acceleration."""

import numpy as np


class StepBounds:
    """The box of postures that one tick may end in.

    Position limits hold unless the start lies outside them; then the joint comes back as fast as its speed allows.
    Acceleration yields to both: braking distance is foreseen, so that from rest inside the limits they never conflict.
    """

    def __init__(
        self, q_min: np.ndarray, q_max: np.ndarray, v_max: np.ndarray, a_max: np.ndarray | None = None
    ) -> None:
        self.q_min, self.q_max, self.v_max, self.a_max = q_min, q_max, v_max, a_max

    def box(self, q_prev: np.ndarray, dt: float, v_prev: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper posture (n,) after a tick of dt [s] from q_prev (n,) moving at v_prev (n,)."""
        reach = self.v_max * dt
        below, above = q_prev - reach, q_prev + reach
        lower = np.minimum(np.maximum(self.q_min, below), above)
        upper = np.maximum(np.minimum(self.q_max, above), below)
        if self.a_max is None or v_prev is None or dt <= 0.0:
            return lower, upper
        dv = self.a_max * dt
        fast = np.minimum(v_prev + dv, braking_speed(self.q_max - q_prev, dv, dt))
        slow = np.maximum(v_prev - dv, -braking_speed(q_prev - self.q_min, dv, dt))
        fast = np.maximum(fast, v_prev - dv)
        slow = np.minimum(slow, v_prev + dv)
        return (
            np.minimum(np.maximum(q_prev + slow * dt, lower), upper),
            np.maximum(np.minimum(q_prev + fast * dt, upper), lower),
        )


def braking_speed(distance: np.ndarray, dv: np.ndarray, dt: float) -> np.ndarray:
    """Largest speed this tick from which braking by dv a tick stops within the distance.

    The ticks cover dt Σ_k max(v - k dv, 0); with n + 1 terms this is dt ((n + 1) v - dv n (n + 1) / 2) = distance.
    """
    distance = np.maximum(distance, 0.0)
    n = np.floor(0.5 * (np.sqrt(1.0 + 8.0 * distance / (dt * dv)) - 1.0))
    return distance / (dt * (n + 1.0)) + 0.5 * n * dv
