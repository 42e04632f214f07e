"""The largest forces, depths and joint speeds of a run."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import ContactResults
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, LeafSystem

from diagrams.geometry.contacts import is_rigid_contact
from diagrams.station.lio_drive import MOVING

POSITION_TOLERANCE = 1e-4
"""[rad] Beyond a joint's stop that is not yet a violation: Drake's stops are nearly rigid and give way by less."""
SPEED_TOLERANCE = 1e-3
"""Share of a joint's speed beyond it that is not yet a violation."""


class Peaks(LeafSystem):
    """Remembers extremes.

    ```
     contact_forces (pairs) [N] → ┌───────┐ → peak_forces (pairs) [N]
                contact_results → │       │ → joint_peaks (2): greatest speed as a share of the joint's, violations
           lio_state (16: q, v) → │ Peaks │ → peak_penetration (1) [m]
            penetration (1) [m] → └───────┘
    ```

    Forces are looked at after every step of the plant, by `look`; joints and depth once a control period. A violation
    is a period at whose end a joint was beyond its stops by more than `POSITION_TOLERANCE`, or beyond its speed by more
    than `SPEED_TOLERANCE`.
    """

    def __init__(
        self, *, contact_pairs: int, stops: tuple[np.ndarray, np.ndarray], speeds: np.ndarray, period: float
    ) -> None:
        """Watch the arm.

        Args:
            contact_pairs: how many there are.
            stops: lowest and highest angle of each arm joint [rad], two of (6,).
            speeds: highest speed of each arm joint [rad/s]. Shape (6,).
            period: of control [s].
        """
        super().__init__()
        low, high = stops
        self._low, self._high = (low - POSITION_TOLERANCE).tolist(), (high + POSITION_TOLERANCE).tolist()
        self._speeds = np.asarray(speeds, dtype=float).tolist()
        self._forces = self.DeclareVectorInputPort("contact_forces", contact_pairs)
        self._results = self.DeclareAbstractInputPort("contact_results", Value[ContactResults]())
        self._lio = self.DeclareVectorInputPort("lio_state", 2 * MOVING)
        self._penetration = self.DeclareVectorInputPort("penetration", 1)
        self._peak_forces = self.DeclareDiscreteState(contact_pairs)
        self._joints = self.DeclareDiscreteState(2)
        self._depth = self.DeclareDiscreteState(1)
        self.DeclareStateOutputPort("peak_forces", self._peak_forces)
        self.DeclareStateOutputPort("joint_peaks", self._joints)
        self.DeclareStateOutputPort("peak_penetration", self._depth)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._tick)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, name: str = "peaks", **kwargs: Any) -> Peaks:
        """Add it to `builder`; `kwargs` as for the constructor.

        Args:
            builder: of the diagram that it is added to.
            name: of the system.
            **kwargs: as for the constructor.
        """
        return builder.AddNamedSystem(name, Peaks(**kwargs))

    def look(self, root: Context) -> None:
        """Look at the forces of the last step of the plant; to be called after each, with the diagram's context.

        Robot and surroundings are rigid: where nothing rigid touches, there is no force between them. Not an event: one
        of those 240 times a second costs 3 % of a run, whatever it does.
        """
        context = self.GetMyMutableContextFromRoot(root)
        if is_rigid_contact(self._results.Eval(context)):
            peaks, forces = context.get_discrete_state(self._peak_forces).value(), self._forces.Eval(context)
            if (forces > peaks).any():
                context.SetDiscreteState(int(self._peak_forces), np.maximum(peaks, forces))

    def _tick(self, context: Context, discrete: DiscreteValues) -> None:
        # Lists, and writing only what changes: numpy's machinery is cold after a step of the plant.
        state = self._lio.Eval(context).tolist()
        share = max([abs(v) / most for v, most in zip(state[MOVING:], self._speeds, strict=False)])
        beyond = share > 1 + SPEED_TOLERANCE
        for q, low, high in zip(state, self._low, self._high, strict=False):
            beyond |= not low <= q <= high
        greatest, violations = context.get_discrete_state(self._joints).value().tolist()
        if beyond or share > greatest:
            discrete.set_value(self._joints, np.array((max(share, greatest), violations + beyond)))
        depth = self._penetration.Eval(context)
        if depth.item() > context.get_discrete_state(self._depth).value().item():
            discrete.set_value(self._depth, depth)
