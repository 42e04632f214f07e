"""A joystick that somebody else samples: a page, a device, a program beside the run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, LeafSystem

from canal.navigation.joystick import JOYSTICK_PERIOD, JOYSTICK_SIZE, clean_joystick


@dataclass(frozen=True)
class LiveSample:
    """What a joystick is at one moment; whatever numbers a device gives, the vector is clean.

    Attributes:
        joystick: the joystick vector (`canal.navigation.joystick`). Shape (6,).
        in_charge: whether a person has the robot, and not the simulated operator.
    """

    joystick: np.ndarray
    in_charge: bool

    def __post_init__(self) -> None:
        object.__setattr__(self, "joystick", clean_joystick(self.joystick))


class LiveJoystick(LeafSystem):
    """Asks for the joystick, 20 times a second.

    ```
    LiveJoystick → joystick (6)
                 → in_charge (1)
    ```
    """

    def __init__(self, read: Callable[[], LiveSample], period: float = JOYSTICK_PERIOD) -> None:
        """Sample `read` every `period` seconds; it must not wait for anything."""
        super().__init__()
        self._read = read
        self.DeclareStateOutputPort("joystick", self.DeclareDiscreteState(JOYSTICK_SIZE))
        self.DeclareStateOutputPort("in_charge", self.DeclareDiscreteState(1))
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._sample)

    @staticmethod
    def AddToBuilder(
        *, builder: DiagramBuilder, read: Callable[[], LiveSample], name: str = "live_joystick"
    ) -> LiveJoystick:
        """Add a joystick that `read` samples to `builder`.

        Args:
            builder: of the diagram that it is added to.
            read: gives the latest sample, and never waits.
            name: of the system.
        """
        return builder.AddNamedSystem(name, LiveJoystick(read))

    def _sample(self, context: Context, discrete: DiscreteValues) -> None:
        sample = self._read()
        discrete.set_value(0, sample.joystick)
        discrete.set_value(1, [float(sample.in_charge)])
