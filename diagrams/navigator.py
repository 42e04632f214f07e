"""The canal navigator: `canal.navigation` as a system with its state in the Context."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, DiscreteValues, LeafSystem

from canal.joystick import JOYSTICK_SIZE
from canal.navigation import (
    FIELD_NAMES,
    NavigationOptions,
    NavigationState,
    initial_state,
    step,
)
from canal.surface import CanalSurface

FINGERS_MOVING = 0.05
"""[rad/s] Fingers faster than this are moving: 5 % of their full speed (SPEC section 6)."""


class CanalNavigator(LeafSystem):
    """Travels a canal under a joystick.

    ```
                     ┌────────────────┐ → X_BT_desired (7)
        joystick (6) →                │ → orientation_weight (1)
    gripper_state (2) → CanalNavigator│ → gripper_command (1)
          alarm (1) →                 │ → navigation_state (len(FIELD_NAMES))
                     └────────────────┘
    ```

    - `joystick`: see `canal.joystick`.
    - `gripper_state`: angle [rad] and rate [rad/s] of the fingers.
    - `alarm`: optional; rising above 0.5 (a contact force beyond its limit) it stops the motion and opens nothing,
      until the person reverses or starts anew.
    - `X_BT_desired`: position [m] and quaternion (w, x, y, z) of the wanted TCP pose in the base frame.
    - `orientation_weight`: w_o(s) of paper V-C.
    - `gripper_command`: 1 closed, 0 open.
    """

    def __init__(self, canal: CanalSurface, options: NavigationOptions | None = None, period: float = 0.01) -> None:
        """Travel `canal`, updating every `period` seconds."""
        super().__init__()
        self._canal = canal
        self._options = options or NavigationOptions()
        self._period = period
        self._joystick = self.DeclareVectorInputPort("joystick", JOYSTICK_SIZE)
        self._gripper_state = self.DeclareVectorInputPort("gripper_state", 2)
        self._alarm = self.DeclareVectorInputPort("alarm", 1)
        state = self.DeclareDiscreteState(initial_state(canal).to_vector())
        from_state = {self.discrete_state_ticket(state)}
        self.DeclareStateOutputPort("navigation_state", state)
        self.DeclareVectorOutputPort("X_BT_desired", 7, self._calc_pose, from_state)
        self.DeclareVectorOutputPort("orientation_weight", 1, self._calc_weight, from_state)
        self.DeclareVectorOutputPort("gripper_command", 1, self._calc_gripper, from_state)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        canal: CanalSurface,
        options: NavigationOptions | None = None,
        period: float = 0.01,
        name: str = "canal_navigator",
    ) -> CanalNavigator:
        """Add a navigator of `canal` to `builder`."""
        return builder.AddNamedSystem(name, CanalNavigator(canal, options, period))

    def state(self, context: Context) -> NavigationState:
        """The navigation state in this system's context."""
        return NavigationState.from_vector(context.get_discrete_state(0).value())

    def _update(self, context: Context, discrete: DiscreteValues) -> None:
        joystick = self._joystick.Eval(context)
        moving = abs(self._gripper_state.Eval(context).item(1)) > FINGERS_MOVING
        alarm = self._alarm.HasValue(context) and self._alarm.Eval(context).item(0) > 0.5
        state = step(
            self._canal,
            self.state(context),
            joystick,
            self._period,
            gripper_moving=moving,
            alarm=alarm,
            options=self._options,
        )
        discrete.set_value(0, state.to_vector())

    def _calc_pose(self, context: Context, output: BasicVector) -> None:
        disk, eta, phi = context.get_discrete_state(0).value()[:3].tolist()
        pose = np.empty(7)
        pose[:3] = self._canal.point(disk, eta, phi)
        pose[3:] = self._canal.orientation(disk)
        output.set_value(pose)

    def _calc_weight(self, context: Context, output: BasicVector) -> None:
        output.SetAtIndex(0, self._canal.weight(context.get_discrete_state(0).value().item(DISK)))

    def _calc_gripper(self, context: Context, output: BasicVector) -> None:
        output.SetAtIndex(0, context.get_discrete_state(0).value().item(GRIPPER_CLOSED))


DISK = FIELD_NAMES.index("disk")
GRIPPER_CLOSED = FIELD_NAMES.index("gripper_closed")
