"""What the drives aim at: commands joined by straight lines, held to the joints' speeds, and the gripper's ramp."""

from __future__ import annotations

import math

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiscreteValues, LeafSystem

from canal.navigation.joystick import in_step

ARM = 6
STIFFNESS = (6000.0, 6000.0, 5000.0, 2500.0, 1500.0, 900.0)
"""Of the arm's drives [N m/rad]."""
DAMPING = (150.0, 150.0, 120.0, 60.0, 35.0, 20.0)
"""[N m s/rad]"""
OPEN_ANGLE = 0.5236
"""Angle of the open gripper [rad] (docs/method.md, 6)."""
CLOSE_TARGET = -0.1
"""Where the closed gripper aims [rad]: past closed, so that the drive's effort limit makes the grip, not its spring."""
GRIPPER_SPEED = 1.047
"""[rad/s] (docs/method.md, 6)."""
PERIOD = in_step(1 / 60)
"""[s] Of the gripper's ramp."""
CLEAR_OF_STOPS = 1e-4
"""The drives aim no nearer to a joint's stop than this [rad]. Drake computes a stop as a nearly rigid constraint once
the joint is nearer to it than it moves in two steps; at rest, with velocities of 1e-9 to 1e-14 rad/s and nothing else
that carries momentum, its SAP solver then does not converge. A tenth of a milliradian off, it never has to."""
AT_REST = 1e-9
"""[rad/s] Slower is no motion, and the aim does not follow it from step to step: the SAP solver, with nothing else that
moves, does not converge when it changes by the rounding of a number."""
CREEP = 0.02
"""[rad/s] Up to this a joint presses on something rather than moves, and its drive aims as far ahead as it did."""
MOVING = ARM + 2
"""Where the speeds begin in the model's state: two fingers come after the arm."""
SPEED_SHARE = 0.97
"""Of a joint's speed that its drive goes up to: when all joints start or stop at once, they push each other 1.6 %
beyond what their drives allow."""


class LioDrive(LeafSystem):
    """Joins what the arm and the gripper are wanted to do.

    ```
     desired_state (12: q, v) → ┌──────────┐
       gripper_command (1)    → │ LioDrive │ → actuator_state (14: q of arm and gripper, v of both)
     lio_state (16: q, v)     → └──────────┘
    ```

    `desired_state` comes once a control period: where the arm is to be at its end, and the speed that brings it there.
    In between the drives are given a straight line: a posture that steps 50 times a second makes the joints swing by
    25 % about the speed that is wanted. As a real drive's inner loop does, they hold the joints' speeds: where a
    position error would drive a joint beyond its speed, the aim is drawn nearer. A desired state that is not finite,
    which the IK never gives, holds the last one that was. `lio_state` is the measured state of the model.
    """

    def __init__(
        self,
        q0: np.ndarray,
        *,
        period: float,
        time_step: float,
        stops: tuple[np.ndarray, np.ndarray] | None = None,
        speeds: np.ndarray | None = None,
        friction: np.ndarray | None = None,
    ) -> None:
        """Start at the arm posture `q0` (6,) with the gripper open.

        Args:
            q0: angles [rad].
            period: between two desired states [s].
            time_step: of the plant [s].
            stops: lowest and highest angle of each arm joint [rad], two of (6,); None for none.
            speeds: highest speed of each arm joint [rad/s], (6,); None for none.
            friction: viscous, of each arm joint [N m s/rad], (6,); None for none.
        """
        super().__init__()
        low, high = stops if stops is not None else (np.full(ARM, -np.inf), np.full(ARM, np.inf))
        self._low, self._high = low + CLEAR_OF_STOPS, high - CLEAR_OF_STOPS
        self._q0 = q0
        self._period = period
        # With torque p (q_d - q) + d (v_d - v), taken at the end of a step h, and friction b v, a joint tends to
        # the speed (p (q_d - q) + d v_d) / (d + b + p h): at most the joint's while |q_d - q + d/p v_d| ≤ `leads`.
        p, d = np.array(STIFFNESS), np.array(DAMPING)
        b = np.zeros(ARM) if friction is None else np.asarray(friction, dtype=float)
        limits = np.full(ARM, np.inf) if speeds is None else SPEED_SHARE * np.asarray(speeds, dtype=float)
        leads = limits * ((d + b) / p + time_step)
        self._joints = list(zip(*(x.tolist() for x in (self._low, self._high, d / p, leads)), strict=True))
        self._desired = self.DeclareVectorInputPort("desired_state", 2 * ARM)
        self._command = self.DeclareVectorInputPort("gripper_command", 1)
        self._measured = self.DeclareVectorInputPort("lio_state", 2 * (ARM + 2))
        # The gripper's target and its rate, then the arm's last posture.
        state = self.DeclareDiscreteState(np.concatenate([[OPEN_ANGLE, 0.0], q0]))
        self._state = state
        sources = {
            self.time_ticket(),
            self.discrete_state_ticket(state),
            self._desired.ticket(),
            self._measured.ticket(),
        }
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
        time = context.get_time()
        left = _time_left(time, self._period)
        measured = self._measured.Eval(context).tolist()
        aims = []
        for k, (low, high, lag, lead) in enumerate(self._joints):
            v = desired[ARM + k]
            aim = desired[k] - v * left if abs(v) > AT_REST else desired[k]
            ahead = aim - measured[k] + lag * v
            if abs(ahead) > lead and abs(measured[MOVING + k]) > CREEP:
                aim -= math.copysign(abs(ahead) - lead, ahead)
            aims.append(low if aim < low else high if aim > high else aim)
        grip = min(target - rate * _time_left(time, PERIOD), OPEN_ANGLE - CLEAR_OF_STOPS)
        output.set_value(np.array((*aims, grip, *desired[ARM:], rate)))

    def start_positions(self) -> np.ndarray:
        """Where the drives hold the model before any command: arm and both fingers [rad], (8,)."""
        fingers = [OPEN_ANGLE - CLEAR_OF_STOPS] * 2
        return np.concatenate([np.clip(self._q0, self._low, self._high), fingers])


def _time_left(time: float, period: float) -> float:
    """[s] until a command's period ends; the step at its end still belongs to it, as updates at the end come after."""
    periods = time / period
    return (math.ceil(periods - 1e-6) - periods) * period
