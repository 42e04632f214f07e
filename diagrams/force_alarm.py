"""The alarm: a contact force above its limit, for as long as it is."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, DiscreteValues, LeafSystem

RELEASE = 0.1
"""Share of the limit below which the force must fall before the alarm ends: the contact is as good as lost then. The
force of an arm that stands against a wall fades (from 160 to 50 N in 5 s); with 0.8 it crept on by a disk a second."""


class ForceAlarm(LeafSystem):
    """Tells the navigator that the robot presses too hard, and which way.

    ```
     contact_forces (pairs) [N] → ┌────────────┐
                                  │ ForceAlarm │ → alarm (4) [N]
             hand_force (3) [N] → └────────────┘
    ```

    `alarm` is the largest of the forces while one is above the limit (else 0), and then the net force on the hand in
    the base frame. The state is whether the alarm lasts.
    """

    def __init__(self, *, contact_pairs: int, limit_n: float, period: float) -> None:
        """Watch `contact_pairs` pairs every `period` seconds; the limit is `limit_n` [N]."""
        super().__init__()
        self._limit_n = limit_n
        self._forces = self.DeclareVectorInputPort("contact_forces", contact_pairs)
        self._hand = self.DeclareVectorInputPort("hand_force", 3)
        self._lasts = self.DeclareDiscreteState(1)
        # Not only from the state: the navigator sees a blow one tick sooner.
        sources = {self._forces.ticket(), self._hand.ticket(), self.discrete_state_ticket(self._lasts)}
        self.DeclareVectorOutputPort("alarm", 4, self._calc_alarm, sources)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)

    @staticmethod
    def AddToBuilder(
        *, builder: DiagramBuilder, contact_pairs: int, limit_n: float, period: float, name: str = "force_alarm"
    ) -> ForceAlarm:
        """Add an alarm to `builder`; arguments as for the constructor.

        Args:
            builder: of the diagram that it is added to.
            contact_pairs: how many are watched.
            limit_n: force above which it rises, [N].
            period: between updates, [s].
            name: of the system.
        """
        return builder.AddNamedSystem(name, ForceAlarm(contact_pairs=contact_pairs, limit_n=limit_n, period=period))

    def _force(self, context: Context) -> float:
        """The force that raises the alarm [N]; 0 for none."""
        force = max(self._forces.Eval(context).tolist(), default=0.0)
        lasts = context.get_discrete_state(self._lasts).value().item(0) > 0.5
        return force if force > self._limit_n * (RELEASE if lasts else 1.0) else 0.0

    def _update(self, context: Context, discrete: DiscreteValues) -> None:
        discrete.set_value(self._lasts, np.array((float(self._force(context) > 0),)))

    def _calc_alarm(self, context: Context, output: BasicVector) -> None:
        output.set_value(np.array((self._force(context), *self._hand.Eval(context).tolist())))
