"""A hand that moves the tool in all six directions: from a jog to the pose that the inverse kinematics is to follow."""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, LeafSystem

from diagrams.geometry.pose_vector import pose_to_vector
from diagrams.ik.kinematics import ArmKinematics
from diagrams.teach.jog import JOG_SIZE, clean_jog, next_wanted, not_pressing, towards

WEIGHT = 0.1
"""Of the orientation. It tells only where a joint is at a stop: there 2° off cost as much as 1 mm, and the tool tilts.
"""


class ToolJog(LeafSystem):
    """Integrates a jog into a wanted pose that the arm can follow.

    ```
               jog (7) → ┌─────────┐
    desired_state (2n) → │         │ → X_BT_desired (7)
          way_back (8) → │ ToolJog │ → orientation_weight (1)
             alarm (4) → └─────────┘ → waited (1)
    ```

    - `jog`: see `diagrams.teach.jog`.
    - `desired_state`: what the arm is commanded to, of the inverse kinematics: the wanted pose waits for it.
    - `way_back`: optional; whether the tool is led back along its path (1, else 0), and where to.
    - `alarm`: optional; see `ForceAlarm`. What presses is held; the way back is free.

    `waited` is how long the arm has not followed a push [s]. The state is the wanted pose, in the robot's base frame,
    and that time.
    """

    def __init__(self, kinematics: ArmKinematics, q_start: np.ndarray, period: float) -> None:
        """Begin where the arm is.

        Args:
            kinematics: of the arm.
            q_start: its posture at the start, [rad]. Shape (n,).
            period: control period, [s].
        """
        super().__init__()
        self._kinematics, self._period = kinematics, period
        self._jog = self.DeclareVectorInputPort("jog", JOG_SIZE)
        self._command = self.DeclareVectorInputPort("desired_state", 2 * kinematics.n)
        self._back = self.DeclareVectorInputPort("way_back", 8)
        self._alarm = self.DeclareVectorInputPort("alarm", 4)
        wanted = self.DeclareDiscreteState(self._pose(q_start))
        self.DeclareStateOutputPort("X_BT_desired", wanted)
        self.DeclareStateOutputPort("waited", self.DeclareDiscreteState(1))
        self.DeclareVectorOutputPort(
            "orientation_weight", 1, lambda context, output: output.SetAtIndex(0, WEIGHT), {self.nothing_ticket()}
        )
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._tick)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        kinematics: ArmKinematics,
        q_start: np.ndarray,
        period: float,
        name: str = "tool_jog",
    ) -> ToolJog:
        """Add a jog to `builder`; arguments as for the constructor.

        Args:
            builder: of the diagram that it is added to.
            kinematics: of the arm.
            q_start: posture at the start, [rad]. Shape (n,).
            period: control period, [s].
            name: of the system.
        """
        return builder.AddNamedSystem(name, ToolJog(kinematics, q_start, period))

    def _pose(self, q: np.ndarray) -> np.ndarray:
        self._kinematics.set(np.asarray(q, dtype=float))
        X = self._kinematics.pose()
        return pose_to_vector(RigidTransform(RotationMatrix(X[:, :3]), X[:, 3]))

    def _tick(self, context: Context, discrete: DiscreteValues) -> None:
        wanted = context.get_discrete_state(0).value()
        discrete.set_value(1, [0.0])
        if self._back.HasValue(context):
            leads, *goal = self._back.Eval(context).tolist()
            if leads > 0.5:
                discrete.set_value(0, towards(wanted, np.array(goal), self._period))
                return
        jog = clean_jog(self._jog.Eval(context))
        if self._alarm.HasValue(context):
            jog = not_pressing(jog, self._alarm.Eval(context).tolist())
        reached = self._pose(self._command.Eval(context)[: self._kinematics.n])
        moved = next_wanted(wanted, reached, jog, self._period)
        discrete.set_value(0, moved)
        if jog.any() and np.array_equal(moved, wanted):
            discrete.set_value(1, context.get_discrete_state(1).value() + self._period)
