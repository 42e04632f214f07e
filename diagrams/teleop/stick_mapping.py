"""The stick's right and up as a person sees them, on whatever disk: between a joystick and the navigator."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, DiscreteValues, LeafSystem, OutputPort

from canal.navigation import FIELD_NAMES
from canal.navigation.joystick import GRIPPER, JOYSTICK_PERIOD, JOYSTICK_SIZE, in_unit_disc
from canal.surface import CanalSurface

DISK = FIELD_NAMES.index("disk")
SMALLEST = 0.1
"""Ratio of the matrix's singular values below which its directions are not told apart."""


class StickMapping(LeafSystem):
    """Turns a stick that says right and up into one along the correction axes.

    ```
        joystick (6) → ┌──────────────┐ → mapped_joystick (6)
    navigation_state → │ StickMapping │ → matrix (4)
                       └──────────────┘
    ```

    `matrix` is M row by row, (k_x, k_y) = M (right, up), on the disk at hand: what somebody needs who knows where the
    point is to go. The discrete state is the directions on each disk, in the base frame, and how often they were
    chosen anew; they change only between two samples of the joystick.
    """

    def __init__(
        self,
        canal: CanalSurface,
        directions: np.ndarray | None,
        choose: Callable[[], tuple[int, np.ndarray | None]] | None = None,
        period: float = JOYSTICK_PERIOD,
    ) -> None:
        """Map by `directions`.

        Args:
            canal: that is travelled.
            directions: of right and up, see `stick_directions`. Shape (N, 2, 3). None: the correction axes
                themselves, as in the paper.
            choose: asked every `period` for other directions: a number that grows with each choice, and the choice.
                None: they stay.
            period: of the joystick [s].
        """
        super().__init__()
        self._canal, self._choose = canal, choose
        self._joystick = self.DeclareVectorInputPort("joystick", JOYSTICK_SIZE)
        self._navigation = self.DeclareVectorInputPort("navigation_state", len(FIELD_NAMES))
        directions = self._or_axes(directions)
        self._directions = self.DeclareDiscreteState(directions.ravel())
        self._chosen = self.DeclareDiscreteState(1)
        of_disk = {self.discrete_state_ticket(self._directions), self._navigation.ticket()}
        self.DeclareVectorOutputPort("matrix", 4, self._calc_matrix, of_disk)
        self.DeclareVectorOutputPort(
            "mapped_joystick", JOYSTICK_SIZE, self._calc_joystick, of_disk | {self._joystick.ticket()}
        )
        if choose is not None:
            self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._look)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        canal: CanalSurface,
        directions: np.ndarray | None,
        joystick: OutputPort,
        navigation_state: OutputPort,
        choose: Callable[[], tuple[int, np.ndarray | None]] | None = None,
        name: str = "stick_mapping",
    ) -> StickMapping:
        """Add a mapping to `builder`, connected to a joystick and to the navigator.

        Args:
            builder: of the diagram that it is added to.
            canal: in the robot's base frame.
            directions: of right and up on each disk. Shape (N, 2, 3). None: the correction axes.
            joystick: port with right and up.
            navigation_state: port of the navigator.
            choose: asked for other directions; None: they stay.
            name: of the system.
        """
        mapping = builder.AddNamedSystem(name, StickMapping(canal, directions, choose))
        builder.Connect(joystick, mapping.GetInputPort("joystick"))
        builder.Connect(navigation_state, mapping.GetInputPort("navigation_state"))
        return mapping

    def _or_axes(self, directions: np.ndarray | None) -> np.ndarray:
        return np.stack([self._canal.x_axes, self._canal.y_axes], axis=1) if directions is None else directions

    def _look(self, context: Context, discrete: DiscreteValues) -> None:
        assert self._choose is not None
        number, directions = self._choose()
        if number != context.get_discrete_state(self._chosen).value().item(0):
            discrete.set_value(self._chosen, [float(number)])
            discrete.set_value(self._directions, self._or_axes(directions).ravel())

    def _matrix(self, context: Context) -> np.ndarray:
        disk = self._navigation.Eval(context).item(DISK)
        n = self._canal.n_disks
        below = min(max(int(disk), 0), n - 2)
        t = min(max(disk - below, 0.0), 1.0)
        both = context.get_discrete_state(self._directions).value()[6 * below : 6 * below + 12].reshape(2, 2, 3)
        x, y = self._canal.axes(disk)
        matrix = np.stack([x, y]) @ ((1 - t) * both[0] + t * both[1]).T
        return matrix / np.maximum(np.linalg.norm(matrix, axis=0), 1e-9)

    def _calc_matrix(self, context: Context, output: BasicVector) -> None:
        output.set_value(self._matrix(context).ravel())

    def _calc_joystick(self, context: Context, output: BasicVector) -> None:
        joystick = self._joystick.Eval(context).copy()
        if joystick[:GRIPPER].any():  # the matrix is no rotation: what it gives may be longer than the stick
            joystick[:GRIPPER] = in_unit_disc(*(self._matrix(context) @ joystick[:GRIPPER]).tolist())
        output.set_value(joystick)


def hand_for(matrix: np.ndarray, stick: np.ndarray) -> np.ndarray:
    """How a hand holds the stick so that it comes out along the correction axes as wanted, or as near as it can.

    Args:
        matrix: M row by row. Shape (4,).
        stick: wanted (k_x, k_y). Shape (2,).

    Returns:
        (right, up), within the unit disc. Shape (2,).
    """
    M = np.asarray(matrix, dtype=float).reshape(2, 2)
    hand = np.linalg.pinv(M, rcond=SMALLEST) @ stick
    return hand / max(math.hypot(*hand), 1.0)
