"""The simulated operator: late and noisy eyes (Drake's delay, seeded noise), and a thumb."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context, Diagram, DiagramBuilder, DiscreteValues, LeafSystem
from pydrake.systems.primitives import DiscreteTimeDelay, Multiplexer

from canal.navigation import FIELD_NAMES, NavigationOptions, NavigationState
from canal.navigation.joystick import GRIPPER, JOYSTICK_PERIOD, JOYSTICK_SIZE
from canal.surface import CanalSurface
from diagrams.geometry.goals import Goal
from diagrams.operator.options import OperatorOptions
from diagrams.operator.policy import OperatorPolicy
from diagrams.operator.state import EYE, Sight
from diagrams.teleop.stick_mapping import hand_for

STATE_SIZE = len(FIELD_NAMES)
"""Numbers in `navigation_state`."""


class OperatorMind(LeafSystem):
    """Turns what is seen into stick and buttons, 20 times a second.

    ```
    sight (13 n + 7 + STATE_SIZE) → OperatorMind → joystick (6)
           person_in_charge (1) →
               stick_matrix (4) →
    ```

    `stick_matrix` (optional) is how the stick is mapped, see `StickMapping`: the hand moves so that the point goes
    where it is wanted.

    While `person_in_charge` (optional) is 1 the hand rests; when it falls, the person looks anew and goes on from what
    is there. `sight` is item_poses (7 n, W), item_bounds (6 n, W), X_BT (7, B) and navigation_state, in this order.
    """

    def __init__(self, policy: OperatorPolicy, X_WB: RigidTransform, delay_s: float, noise_m: float) -> None:
        """Decide by `policy`; the base stands at `X_WB`; `delay_s` is when the first sight arrives."""
        super().__init__()
        n = len(policy.goals)
        self._policy, self._n = policy, n
        self._X_BW = X_WB.inverse()
        self._delay_s, self._noise_m = delay_s, noise_m
        self._sight = self.DeclareVectorInputPort("sight", 13 * n + 7 + STATE_SIZE)
        self._person = self.DeclareVectorInputPort("person_in_charge", 1)
        self._matrix = self.DeclareVectorInputPort("stick_matrix", 4)
        mind = self.DeclareDiscreteState(policy.initial())
        hand = self.DeclareDiscreteState(JOYSTICK_SIZE)
        self._mind, self._hand = mind, hand
        self.DeclareStateOutputPort("joystick", hand)
        self.DeclarePeriodicDiscreteUpdateEvent(JOYSTICK_PERIOD, 0.0, self._update)

    def _update(self, context: Context, discrete: DiscreteValues) -> None:
        time = context.get_time()
        mind = context.get_discrete_state(self._mind).value()
        if self._person.HasValue(context) and self._person.Eval(context).item(0) > 0.5:
            discrete.set_value(self._mind, self._policy.waiting(mind, time))
            discrete.set_value(self._hand, np.zeros(JOYSTICK_SIZE))
            return
        if time > self._delay_s + 2.5 * JOYSTICK_PERIOD:  # before that nothing has been sampled, and reached the eye
            mind = self._policy.decide(mind, self._look(self._sight.Eval(context), time), time)
        discrete.set_value(self._mind, mind)
        joystick = self._policy.joystick(mind, time)
        if self._matrix.HasValue(context) and joystick[:GRIPPER].any():
            joystick[:GRIPPER] = hand_for(self._matrix.Eval(context), joystick[:GRIPPER])
        discrete.set_value(self._hand, joystick)

    def _look(self, sight: np.ndarray, time: float) -> Sight:
        n = self._n
        poses = sight[: 7 * n].reshape(n, 7).copy()
        bounds = sight[7 * n : 13 * n].reshape(n, 6).copy()
        rng = np.random.default_rng((self._policy.seed, EYE, round(time / JOYSTICK_PERIOD)))
        wrong = rng.normal(0.0, self._noise_m, (n, 3))
        poses[:, :3] += wrong
        bounds += np.hstack([wrong, wrong])
        # In doubt an item hangs out: what is seen a little wrong must be inside by more than that.
        doubt = np.repeat([-2.0, 2.0], 3) * self._noise_m
        placed = [g.placed(p, b + doubt) for g, p, b in zip(self._policy.goals, poses, bounds, strict=True)]
        # A mark is met by the item's origin; a crumpled item is gripped at its middle.
        seen = [
            p[:3] if g.precise else (b[:3] + b[3:]) / 2
            for g, p, b in zip(self._policy.goals, poses, bounds, strict=True)
        ]
        return Sight(
            positions=np.array([self._X_BW.multiply(p) for p in seen]).reshape(n, 3),
            placed=np.array(placed, dtype=bool),
            p_BT=sight[13 * n : 13 * n + 3].copy(),
            navigation=NavigationState.from_vector(sight[13 * n + 7 :]),
        )


class SimulatedOperator(Diagram):
    """A person who sees as a person does, and has only a stick and four buttons.

    ```
          item_poses (7 n) →  ┌───────┐    ┌───────────────────┐    ┌──────────────┐
         item_bounds (6 n) →  │ joined│ →  │ 0.25 s late, 20 Hz│ →  │ OperatorMind │ → joystick (6)
                 X_BT (7)  →  │       │    └───────────────────┘    └──────────────┘
          navigation_state →  └───────┘                                person_in_charge (1), stick_matrix (4) ↑
    ```
    """

    def __init__(
        self,
        *,
        canal: CanalSurface,
        goals: list[Goal],
        X_WB: RigidTransform,
        options: OperatorOptions | None = None,
        navigation: NavigationOptions | None = None,
        seed: int = 0,
    ) -> None:
        """A person who brings item i to `goals[i]` by `canal`, from a base at `X_WB`; all draws from `seed`."""
        super().__init__()
        options = options or OperatorOptions()
        navigation = navigation or NavigationOptions()
        X_BW = X_WB.inverse()
        policy = OperatorPolicy(
            canal,
            goals,
            options,
            stick_speed=20.0 / navigation.delta,
            p_BG=np.array([X_BW.multiply(goal.position) for goal in goals]).reshape(-1, 3),
            seed=seed,
        )
        n = len(goals)
        sizes = {"item_poses": 7 * n, "item_bounds": 6 * n, "X_BT": 7, "navigation_state": STATE_SIZE}
        builder = DiagramBuilder()
        joined = builder.AddNamedSystem("sight", Multiplexer(list(sizes.values())))
        mind = builder.AddNamedSystem("mind", OperatorMind(policy, X_WB, options.delay_s, options.noise_m))
        late = builder.AddNamedSystem(
            "late", DiscreteTimeDelay(JOYSTICK_PERIOD, round(options.delay_s / JOYSTICK_PERIOD), sum(sizes.values()))
        )
        for index, name in enumerate(sizes):
            builder.ExportInput(joined.get_input_port(index), name)
        builder.Connect(joined.get_output_port(), late.get_input_port())
        builder.Connect(late.get_output_port(), mind.GetInputPort("sight"))
        for name in ("person_in_charge", "stick_matrix"):
            builder.ExportInput(mind.GetInputPort(name), name)
        builder.ExportOutput(mind.GetOutputPort("joystick"), "joystick")
        builder.BuildInto(self)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, name: str = "simulated_operator", **kwargs: Any) -> SimulatedOperator:
        """Add a simulated operator to `builder`; `kwargs` as for the constructor.

        Args:
            builder: of the diagram that it is added to.
            name: of the system.
            **kwargs: as for the constructor.
        """
        return builder.AddNamedSystem(name, SimulatedOperator(**kwargs))
