"""The inverse kinematics as a system: a wanted pose in, a joint command out, at the control rate."""

import enum
from typing import Any

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, LeafSystem, OutputPort

from canal.errors import InputError
from diagrams.ik.solver import IkSolver

CONTROL_PERIOD = 0.01  # [s]


class IkStatusField(enum.IntEnum):
    """Indices in the `ik_status` vector."""

    STATUS = 0
    """`diagrams.ik.options.IkStatus`."""
    SOLVE_TIME = 1
    """Wall clock [s]: the one value that a replay does not repeat; 0 where nothing had to be solved."""
    BOUND_VIOLATION = 2
    """Largest excess over this tick's bounds [rad]."""
    POSITION_ERROR = 3
    """[m], NaN when held."""
    ORIENTATION_ERROR = 4
    """[rad], NaN when held."""
    COST = 5
    """f(q), NaN when held."""
    ITERATIONS = 6
    CLEARANCE = 7
    """Least distance of a watched pair [m], NaN when none is watched."""


class OrientationWeightedIk(LeafSystem):
    """Follows a wanted tool pose with the posture that is best within each tick's bounds.

    ```
                          ┌───────────────────────┐
    X_BT_desired (7)    → │                       │ → desired_state (2n)
    orientation_weight  → │ OrientationWeightedIk │ → ik_status (8)
        (1)               └───────────────────────┘
    ```

    desired_state is q_command then v_command; X_BT_desired is position [m] and quaternion (w, x, y, z). The state is
    the last command and the last status, updated every `period`; nothing is kept on the object. An input that is not
    finite holds the posture and says so in `ik_status`.
    """

    def __init__(self, solver: IkSolver, *, q_start: np.ndarray, period: float = CONTROL_PERIOD) -> None:
        super().__init__()
        n = solver.n
        q_start = np.asarray(q_start, dtype=float)
        if q_start.shape != (n,) or not np.all(np.isfinite(q_start)):
            raise InputError(f"q_start {q_start}: give {n} finite joint positions")
        self._solver, self._period = solver, period
        self._target_port = self.DeclareVectorInputPort("X_BT_desired", 7)
        self._weight_port = self.DeclareVectorInputPort("orientation_weight", 1)
        command = self.DeclareDiscreteState(np.concatenate((q_start, np.zeros(n))))
        status = self.DeclareDiscreteState(len(IkStatusField))
        # Pose and weights that the posture has been held for; not finite while it moves.
        self._held_for = int(self.DeclareDiscreteState(np.full(8, np.nan)))
        self._command, self._status = int(command), int(status)
        self.DeclareStateOutputPort("desired_state", command)
        self.DeclareStateOutputPort("ik_status", status)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._tick)

    @property
    def solver(self) -> IkSolver:
        """The solver, for reports; it has no state."""
        return self._solver

    def _tick(self, context: Context, updates: DiscreteValues) -> None:
        n = self._solver.n
        command = context.get_discrete_state().value(self._command)
        q_prev = command[:n]
        target: Any = self._target_port.Eval(context)
        weight: Any = self._weight_port.Eval(context)
        asked = [*target.tolist(), *weight.tolist()]
        if asked == context.get_discrete_state().value(self._held_for).tolist():
            status = context.get_discrete_state().value(self._status).copy()
            status[IkStatusField.SOLVE_TIME] = 0.0
            updates.set_value(self._status, status)
            return  # the same question from the same posture at rest: the same answer
        result = self._solver.solve(target, weight, q_prev, self._period, command[n:])
        updates.set_value(self._command, np.concatenate((result.q, (result.q - q_prev) / self._period)))
        held = np.array_equal(result.q, q_prev) and not command[n:].any()
        updates.set_value(self._held_for, np.array(asked) if held else np.full(len(asked), np.nan))
        updates.set_value(
            self._status,
            np.array(
                (
                    result.status,
                    result.solve_time,
                    result.bound_violation,
                    result.position_error,
                    result.orientation_error,
                    result.cost,
                    result.iterations,
                    result.clearance,
                )
            ),
        )

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        solver: IkSolver,
        q_start: np.ndarray,
        X_BT_desired: OutputPort | None = None,
        orientation_weight: OutputPort | None = None,
        period: float = CONTROL_PERIOD,
        name: str = "ik",
    ) -> "OrientationWeightedIk":
        """Add the system, connect the ports that are given, return it.

        Args:
            builder: of the diagram that it is added to.
            solver: of the arm alone: its plant is a copy for kinematics, never the one that is simulated.
            q_start: first command, [rad]. Shape (n,).
            X_BT_desired: port that is connected; None: not yet.
            orientation_weight: likewise.
            period: between updates, [s].
            name: of the system.
        """
        system = builder.AddNamedSystem(name, OrientationWeightedIk(solver, q_start=q_start, period=period))
        if X_BT_desired is not None:
            builder.Connect(X_BT_desired, system.GetInputPort("X_BT_desired"))
        if orientation_weight is not None:
            builder.Connect(orientation_weight, system.GetInputPort("orientation_weight"))
        return system
