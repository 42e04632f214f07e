"""The drives' desired state: the arm's as it comes, the gripper's as a ramp."""

from __future__ import annotations

import math

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiscreteValues, LeafSystem

from canal.joystick import in_step

ARM = 6
OPEN_ANGLE = 0.5236
"""Angle of the open gripper [rad] (SPEC section 6)."""
CLOSE_TARGET = -0.1
"""Where the closed gripper aims [rad]: past closed, so that the drive's effort limit makes the grip, not its spring."""
GRIPPER_SPEED = 1.047
"""[rad/s] (SPEC section 6)."""
PERIOD = in_step(1 / 60)
"""[s] Of the gripper's ramp."""
CLEAR_OF_STOPS = 1e-4
"""The drives aim no nearer to a joint's stop than this [rad]. Drake computes a stop as a nearly rigid constraint once
the joint is nearer to it than it moves in two steps; at rest, with velocities of 1e-9 to 1e-14 rad/s and nothing else
that carries momentum, its SAP solver then does not converge. A tenth of a milliradian off, it never has to."""


class LioDrive(LeafSystem):
    """Joins what the arm and the gripper are wanted to do.

    ```
     desired_state (12: q, v) → ┌──────────┐
                                │ LioDrive │ → actuator_state (14: q of arm and gripper, v of both)
       gripper_command (1)    → └──────────┘
    ```

    A desired state that is not finite, which the IK never gives, holds the last one that was.
    """

    def __init__(self, q0: np.ndarray, stops: tuple[np.ndarray, np.ndarray] | None = None) -> None:
        """Start at the arm posture `q0` (6,) with the gripper open.

        Args:
            q0: angles [rad].
            stops: lowest and highest angle of each arm joint [rad], two of (6,); None for none.
        """
        super().__init__()
        low, high = stops if stops is not None else (np.full(ARM, -np.inf), np.full(ARM, np.inf))
        self._low = np.array((*(low + CLEAR_OF_STOPS), -np.inf))
        self._high = np.array((*(high - CLEAR_OF_STOPS), OPEN_ANGLE - CLEAR_OF_STOPS))
        self._q0 = np.array((*q0, OPEN_ANGLE))
        self._desired = self.DeclareVectorInputPort("desired_state", 2 * ARM)
        self._command = self.DeclareVectorInputPort("gripper_command", 1)
        # The gripper's target and its rate, then the arm's last posture.
        state = self.DeclareDiscreteState(np.concatenate([[OPEN_ANGLE, 0.0], q0]))
        self._state = state
        # Not of time: the plant's steps between two ticks find it in the cache.
        sources = {self.discrete_state_ticket(state), self._desired.ticket()}
        self.DeclareVectorOutputPort("actuator_state", 2 * (ARM + 1), self._calc, sources)
        self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)

    def _update(self, context: Context, discrete: DiscreteValues) -> None:
        target, _, *q = context.get_discrete_state(self._state).value().tolist()
        closed = self._command.Eval(context).item(0) > 0.5
        step = GRIPPER_SPEED * PERIOD
        next_target = min(max(CLOSE_TARGET if closed else OPEN_ANGLE, target - step), target + step)
        desired = self._desired.Eval(context).tolist()
        if all(map(math.isfinite, desired)):
            q = desired[:ARM]
        discrete.set_value(self._state, np.array((next_target, (next_target - target) / PERIOD, *q)))

    def _calc(self, context: Context, output: BasicVector) -> None:
        target, rate, *q = context.get_discrete_state(self._state).value().tolist()
        desired = self._desired.Eval(context).tolist()
        if not all(map(math.isfinite, desired)):
            desired = q + [0.0] * ARM
        positions = np.maximum(self._low, np.minimum(self._high, (*desired[:ARM], target)))
        output.set_value(np.array((*positions, *desired[ARM:], rate)))

    def start_positions(self) -> np.ndarray:
        """Where the drives hold the model before any command: arm and both fingers [rad], (8,)."""
        positions = np.clip(self._q0, self._low, self._high)
        return np.append(positions, positions[-1])
