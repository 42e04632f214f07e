"""The canal navigator: `canal.navigation.travel` as a system with its state in the Context."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, DiscreteValues, LeafSystem

from canal.navigation import (
    FIELD_NAMES,
    NavigationOptions,
    NavigationState,
    initial_state,
    step,
)
from canal.navigation.joystick import JOYSTICK_PERIOD, JOYSTICK_SIZE
from canal.surface import CanalSurface

FINGERS_MOVING = 0.05
"""[rad/s] Fingers faster than this are moving: 5 % of their full speed (docs/method.md, 6)."""


class CanalNavigator(LeafSystem):
    """Travels a canal under a joystick.

    ```
                     ┌────────────────┐ → X_BT_desired (7)
        joystick (6) →                │ → orientation_weight (1)
    gripper_state (2) → CanalNavigator│ → gripper_command (1)
          alarm (4) →                 │ → navigation_state (len(FIELD_NAMES))
                     └────────────────┘
    ```

    - `joystick`: see `canal.navigation.joystick`.
    - `gripper_state`: angle [rad] and rate [rad/s] of the fingers.
    - `alarm`: optional; the contact force that is above its limit [N], 0 for none, and the net force on the hand in the
      base frame [N] (see `canal.navigation.pressing`).
    - `X_BT_desired`: position [m] and quaternion (w, x, y, z) of the wanted TCP pose in the base frame.
    - `orientation_weight`: w_o(s) of paper V-C.
    - `gripper_command`: 1 closed, 0 open.

    The stick is integrated by time: it holds from one 20 Hz sample to the next, and at a control rate that is no
    multiple of 20 Hz the navigator steps at the samples, too. So each sample moves the point equally far at any rate.
    What is put out changes at the control rate only.
    """

    def __init__(self, canal: CanalSurface, options: NavigationOptions | None = None, period: float = 0.01) -> None:
        """Travel `canal`, updating every `period` seconds."""
        super().__init__()
        self._canal = canal
        self._options = options or NavigationOptions()
        self._longest = max(period, JOYSTICK_PERIOD)
        self._joystick = self.DeclareVectorInputPort("joystick", JOYSTICK_SIZE)
        self._gripper_state = self.DeclareVectorInputPort("gripper_state", 2)
        self._alarm = self.DeclareVectorInputPort("alarm", 4)
        start = initial_state(canal).to_vector()
        state = self.DeclareDiscreteState(start)
        # The state as of the last step, and its time [s]; the one above is as of the last tick.
        self._latest = self.DeclareDiscreteState(np.append(start, 0.0))
        from_state = {self.discrete_state_ticket(state)}
        self.DeclareStateOutputPort("navigation_state", state)
        self.DeclareVectorOutputPort("X_BT_desired", 7, self._calc_pose, from_state)
        self.DeclareVectorOutputPort("orientation_weight", 1, self._calc_weight, from_state)
        self.DeclareVectorOutputPort("gripper_command", 1, self._calc_gripper, from_state)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._tick)
        ticks = JOYSTICK_PERIOD / period
        if abs(ticks - round(ticks)) > 1e-9:
            self.DeclarePeriodicDiscreteUpdateEvent(JOYSTICK_PERIOD, 0.0, self._sample)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        canal: CanalSurface,
        options: NavigationOptions | None = None,
        period: float = 0.01,
        name: str = "canal_navigator",
    ) -> CanalNavigator:
        """Add a navigator of `canal` to `builder`.

        Args:
            builder: of the diagram that it is added to.
            canal: that is travelled.
            options: None for the defaults.
            period: between updates, [s].
            name: of the system.
        """
        return builder.AddNamedSystem(name, CanalNavigator(canal, options, period))

    def state(self, context: Context) -> NavigationState:
        """The navigation state in this system's context."""
        return NavigationState.from_vector(context.get_discrete_state(0).value())

    def _sample(self, context: Context, discrete: DiscreteValues) -> None:
        self._advance(context, discrete)

    def _tick(self, context: Context, discrete: DiscreteValues) -> None:
        discrete.set_value(0, self._advance(context, discrete))

    def _advance(self, context: Context, discrete: DiscreteValues) -> np.ndarray:
        """Step from the last step until now, under the joystick as it was until now; the state after it."""
        *before, time = context.get_discrete_state(self._latest).value().tolist()
        moving = abs(self._gripper_state.Eval(context).item(1)) > FINGERS_MOVING
        alarm, *force = self._alarm.Eval(context).tolist() if self._alarm.HasValue(context) else (0.0,) * 4
        state = step(
            self._canal,
            NavigationState(*before),
            self._joystick.Eval(context),
            min(context.get_time() - time, self._longest),
            gripper_moving=moving,
            alarm=alarm,
            force=force,
            options=self._options,
        ).to_vector()
        discrete.set_value(self._latest, np.append(state, context.get_time()))
        return state

    def _calc_pose(self, context: Context, output: BasicVector) -> None:
        disk, eta, phi = context.get_discrete_state(0).value()[:3].tolist()
        output.set_value(self._canal.pose(disk, eta, phi))

    def _calc_weight(self, context: Context, output: BasicVector) -> None:
        output.SetAtIndex(0, self._canal.weight(context.get_discrete_state(0).value().item(DISK)))

    def _calc_gripper(self, context: Context, output: BasicVector) -> None:
        output.SetAtIndex(0, context.get_discrete_state(0).value().item(GRIPPER_CLOSED))


DISK = FIELD_NAMES.index("disk")
"""Index of the disk in `navigation_state`."""
GRIPPER_CLOSED = FIELD_NAMES.index("gripper_closed")
"""Index of the gripper's command in `navigation_state`."""
