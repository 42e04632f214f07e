"""The monitor: the study's measures, success, safety, and the end of a run with a reason (SPEC section 7)."""

import math

import numpy as np
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, EventStatus, LeafSystem

from canal.joystick import JOYSTICK_PERIOD
from canal.navigation import FIELD_NAMES, NavigationState, phase
from canal.options import NotNegative, Positive, Share, options
from canal.surface import CanalSurface
from diagrams.goals import Goal


@options("monitor")
class MonitorOptions:
    """What counts as done, and as dangerous."""

    rest_speed: Positive = 0.05
    """[m/s] A thing slower than this is at rest: crumpled clothes go on breathing."""
    held_distance_m: NotNegative = 0.16
    """A thing nearer to a closed gripper than this is still held."""
    force_limit_n: Positive = 150.0
    """Contact force between robot and surroundings above which the motion stops: ISO/TS 15066's bound for transient
    contact with the back of the hand is 280 N, quasi-static 140 N; a care robot stays about the latter."""
    clear_phase: Share = 0.5
    """|d| below which the robot has left the goal, so that the run can end."""


class Monitor(LeafSystem):
    """Watches and measures; ends the run when all is done.

    ```
            item_poses (7 n) → ┌─────────┐
           item_bounds (6 n) → │         │
             item_speeds (n) → │ Monitor │ → placed_times (n), negative: not placed
                    X_BT (7) → │         │ → peak_forces (pairs) [N]
           navigation_state  → │         │ → measures (2): measured correction distance [m], peak penetration [m]
     contact_forces (pairs)  → │         │
            penetration (1)  → │         │
       person_in_charge (1)  → └─────────┘
    ```

    `person_in_charge` is optional: a person's stop, live or recorded, is a pause; the simulated operator's ends the
    run.
    """

    def __init__(
        self,
        *,
        canal: CanalSurface,
        goals: list[Goal],
        contact_pairs: int,
        X_WB: RigidTransform | None = None,
        options: MonitorOptions | None = None,
        period: float = 0.01,
    ) -> None:
        """Judge thing i by `goals[i]` and watch `contact_pairs` pairs, every `period` seconds; base at `X_WB`."""
        super().__init__()
        self._canal, self._goals = canal, goals
        self._options = options or MonitorOptions()
        self._X_WB = X_WB or RigidTransform()
        n = self._n = len(goals)
        self._poses = self.DeclareVectorInputPort("item_poses", 7 * n)
        self._bounds = self.DeclareVectorInputPort("item_bounds", 6 * n)
        self._speeds = self.DeclareVectorInputPort("item_speeds", n)
        self._X_BT = self.DeclareVectorInputPort("X_BT", 7)
        self._navigation = self.DeclareVectorInputPort("navigation_state", len(FIELD_NAMES))
        self._forces = self.DeclareVectorInputPort("contact_forces", contact_pairs)
        self._penetration = self.DeclareVectorInputPort("penetration", 1)
        self._person = self.DeclareVectorInputPort("person_in_charge", 1)
        self._placed_times = self.DeclareDiscreteState(np.full(n, -1.0))
        self._peaks = self.DeclareDiscreteState(contact_pairs)
        self._measures = self.DeclareDiscreteState(2)
        # Started, correcting and the TCP at the last look [m].
        self._last = self.DeclareDiscreteState(5)
        self.DeclareStateOutputPort("placed_times", self._placed_times)
        self.DeclareStateOutputPort("peak_forces", self._peaks)
        self.DeclareStateOutputPort("measures", self._measures)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._watch)
        # Where things lie changes slowly, and is dear to compute: judged as often as a person looks.
        self.DeclarePeriodicDiscreteUpdateEvent(JUDGING_PERIOD, JUDGING_PERIOD, self._judge)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, name: str = "monitor", **kwargs) -> "Monitor":
        """Add a monitor to `builder`; `kwargs` as for the constructor."""
        return builder.AddNamedSystem(name, Monitor(**kwargs))

    def _watch(self, context: Context, discrete: DiscreteValues) -> None:
        forces = self._forces.Eval(context)
        peaks = np.maximum(context.get_discrete_state(self._peaks).value(), forces)
        distance, penetration = context.get_discrete_state(self._measures).value().tolist()
        started, was_correcting, *last = context.get_discrete_state(self._last).value().tolist()
        navigation = self._navigation.Eval(context)
        correcting, running = navigation.item(CORRECTING), navigation.item(RUNNING)
        p_BT = self._X_BT.Eval(context)[:3].tolist()
        if correcting and was_correcting:
            distance += math.dist(p_BT, last)
        now = self._penetration.Eval(context).item(0)
        penetration = now if now > penetration else penetration
        discrete.set_value(self._peaks, peaks)
        discrete.set_value(self._measures, np.array((distance, penetration)))
        discrete.set_value(self._last, np.array((float(started or running), correcting, *p_BT)))

    def _judge(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        options, n = self._options, self._n
        poses = self._poses.Eval(context).reshape(n, 7)
        bounds = self._bounds.Eval(context).reshape(n, 6)
        speeds = self._speeds.Eval(context)
        navigation = NavigationState.from_vector(self._navigation.Eval(context))
        p_WT = self._X_WB.multiply(self._X_BT.Eval(context)[:3])
        times = context.get_discrete_state(self._placed_times).value().copy()
        for i, goal in enumerate(self._goals):
            middle = (bounds[i, :3] + bounds[i, 3:]) / 2
            held = navigation.gripper_closed and np.linalg.norm(middle - p_WT) < options.held_distance_m
            placed = not held and speeds[i] < options.rest_speed and goal.placed(poses[i], bounds[i])
            if not placed:
                times[i] = -1.0
            elif times[i] < 0:
                times[i] = context.get_time()
        discrete.set_value(self._placed_times, times)
        started = context.get_discrete_state(self._last).value()[0]
        clear = abs(phase(self._canal, navigation.disk)) < options.clear_phase
        if n and (times >= 0).all() and clear:
            return EventStatus.ReachedTermination(self, "every thing is in its place")
        person = self._person.HasValue(context) and self._person.Eval(context)[0] > 0.5
        if started and not navigation.running and not person:
            return EventStatus.ReachedTermination(self, f"the operator stopped with {(times >= 0).sum()} of {n} placed")
        return EventStatus.Succeeded()


CORRECTING, RUNNING = FIELD_NAMES.index("correcting"), FIELD_NAMES.index("running")
"""Places in the navigation state: of 21 numbers these two are all that is needed at the control rate."""
JUDGING_PERIOD = JOYSTICK_PERIOD
"""[s] The things are judged 20 times a second."""
