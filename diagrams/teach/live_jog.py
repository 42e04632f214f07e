"""The hand that teaches, sampled 20 times a second: a jog, the gripper, and what is said to the recorder."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, LeafSystem

from canal.navigation.joystick import JOYSTICK_PERIOD
from diagrams.teach.jog import JOG_SIZE, clean_jog
from diagrams.teach.path import Word


@dataclass(frozen=True)
class TeachSample:
    """What the hand does at one moment.

    Attributes:
        jog: see `diagrams.teach.jog`. Shape (7,).
        gripper: whether the gripper is pressed: it opens or closes.
        word: to the recorder.
    """

    jog: np.ndarray = field(default_factory=lambda: np.zeros(JOG_SIZE))
    gripper: bool = False
    word: Word = Word.NOTHING


class LiveJog(LeafSystem):
    """Asks for the hand.

    ```
    LiveJog → jog (7)
            → gripper_command (1)
            → word (1)
    ```

    The gripper closes at a command of 1, opens at 0; the hand's press changes it.
    """

    def __init__(self, read: Callable[[], TeachSample]) -> None:
        """Sample `read`, which must not wait for anything."""
        super().__init__()
        self._read = read
        self.DeclareStateOutputPort("jog", self.DeclareDiscreteState(JOG_SIZE))
        self.DeclareStateOutputPort("gripper_command", self.DeclareDiscreteState(1))
        self.DeclareStateOutputPort("word", self.DeclareDiscreteState(1))
        self.DeclarePeriodicDiscreteUpdateEvent(JOYSTICK_PERIOD, 0.0, self._sample)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, read: Callable[[], TeachSample], name: str = "live_jog") -> LiveJog:
        """Add a hand that `read` samples to `builder`.

        Args:
            builder: of the diagram that it is added to.
            read: gives the latest sample, and never waits.
            name: of the system.
        """
        return builder.AddNamedSystem(name, LiveJog(read))

    def _sample(self, context: Context, discrete: DiscreteValues) -> None:
        sample = self._read()
        closed = context.get_discrete_state(1).value().item(0) > 0.5
        discrete.set_value(0, clean_jog(sample.jog))
        discrete.set_value(1, [float(closed != sample.gripper)])
        discrete.set_value(2, [float(sample.word)])
