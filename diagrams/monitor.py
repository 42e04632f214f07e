"""The monitor: what is placed, since when, and the end of a run with a reason (docs/method.md, 7)."""

from typing import Any

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, EventStatus, LeafSystem

from canal.navigation import FIELD_NAMES, NavigationState, phase
from canal.navigation.joystick import JOYSTICK_PERIOD
from canal.options import Positive, Share, options
from canal.surface import CanalSurface
from diagrams.geometry.goals import Goal


@options("monitor")
class MonitorOptions:
    """What counts as done, and as dangerous."""

    rest_speed: Positive = 0.05
    """[m/s] An item slower than this is at rest: crumpled clothes go on breathing."""
    force_limit_n: Positive = 150.0
    """Contact force between robot and surroundings above which the motion stops: ISO/TS 15066's bound for transient
    contact with the back of the hand is 280 N, quasi-static 140 N; a care robot stays about the latter."""
    clear_phase: Share = 0.5
    """|d| below which the robot has left the goal, so that the run can end."""


class Monitor(LeafSystem):
    """Judges where items are; ends the run when all is done.

    ```
            item_poses (7 n) → ┌─────────┐
           item_bounds (6 n) → │         │
             item_speeds (n) → │ Monitor │ → placed_times (n) [s], negative: not placed
             grip_forces (n) → │         │
           navigation_state  → │         │
       person_in_charge (1)  → └─────────┘
    ```

    An item is placed while it is where it belongs, slower than `rest_speed`, and no finger touches it. Its time is when
    it came to rest there and was free; a finger that touches it again, but does not move it, leaves that as it is.
    `person_in_charge` is optional: a person's stop, live or recorded, is a pause; the simulated operator's ends the
    run.
    """

    def __init__(self, *, canal: CanalSurface, goals: list[Goal], options: MonitorOptions | None = None) -> None:
        """Judge item i by `goals[i]`; the robot has left them where it is at `clear_phase` of `canal`."""
        super().__init__()
        self._canal, self._goals = canal, goals
        self._options = options or MonitorOptions()
        n = self._n = len(goals)
        self._poses = self.DeclareVectorInputPort("item_poses", 7 * n)
        self._bounds = self.DeclareVectorInputPort("item_bounds", 6 * n)
        self._speeds = self.DeclareVectorInputPort("item_speeds", n)
        self._grips = self.DeclareVectorInputPort("grip_forces", n)
        self._navigation = self.DeclareVectorInputPort("navigation_state", len(FIELD_NAMES))
        self._person = self.DeclareVectorInputPort("person_in_charge", 1)
        self._placed_times = self.DeclareDiscreteState(np.full(n, -1.0))
        # When each item came to rest, whether or not a finger touches it now; and whether the run has been started.
        self._rest_times = self.DeclareDiscreteState(np.full(n, -1.0))
        self._started = self.DeclareDiscreteState(1)
        self.DeclareStateOutputPort("placed_times", self._placed_times)
        # Where items lie changes slowly, and is dear to compute: judged as often as a person looks.
        self.DeclarePeriodicDiscreteUpdateEvent(JUDGING_PERIOD, JUDGING_PERIOD, self._judge)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, name: str = "monitor", **kwargs: Any) -> "Monitor":
        """Add a monitor to `builder`; `kwargs` as for the constructor.

        Args:
            builder: of the diagram that it is added to.
            name: of the system.
            **kwargs: as for the constructor.
        """
        return builder.AddNamedSystem(name, Monitor(**kwargs))

    def _judge(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        options, n = self._options, self._n
        poses = self._poses.Eval(context).reshape(n, 7)
        bounds = self._bounds.Eval(context).reshape(n, 6)
        speeds = self._speeds.Eval(context)
        touched = self._grips.Eval(context) > 0
        navigation = NavigationState.from_vector(self._navigation.Eval(context))
        rests = context.get_discrete_state(self._rest_times).value().copy()
        for i, goal in enumerate(self._goals):
            if speeds[i] >= options.rest_speed or not goal.placed(poses[i], bounds[i]):
                rests[i] = -1.0
            elif rests[i] < 0 and not touched[i]:
                rests[i] = context.get_time()
        times = np.where(touched, -1.0, rests)
        discrete.set_value(self._rest_times, rests)
        discrete.set_value(self._placed_times, times)
        started = context.get_discrete_state(self._started).value().item() or navigation.running
        discrete.set_value(self._started, np.array((float(bool(started)),)))
        clear = abs(phase(self._canal, navigation.disk)) < options.clear_phase
        if n and (times >= 0).all() and clear:
            return EventStatus.ReachedTermination(self, ALL_PLACED)
        person = self._person.HasValue(context) and self._person.Eval(context)[0] > 0.5
        if started and not navigation.running and not person:
            return EventStatus.ReachedTermination(self, f"the operator stopped with {(times >= 0).sum()} of {n} placed")
        return EventStatus.Succeeded()


ALL_PLACED = "every item is placed"
"""The reason of a run that is done."""
JUDGING_PERIOD = JOYSTICK_PERIOD
"""[s] The items are judged as often as the joystick is sampled, so that no start or stop is missed."""
