"""The arm sleeps, too: while nobody commands it and nothing near it moves, its joints are locked.

Locking is a parameter of the plant; what the arm was commanded to do when it fell asleep, since when, and what touched
it then are state of `Standing`. It wakes on the first step of the plant that would have another command, with the
posture that it had: a drive that pressed on something presses with the same force again.
"""

from __future__ import annotations

import weakref

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import BasicVector, Context, LeafSystem

STANDS = 0.5
"""[s] A command that has not changed for so long is one to stand still: some twenty time constants of the drives."""
ARM_STILL = 2e-3
"""[rad/s] An arm that nobody commands and that is no faster than this stands. One that presses on a table with 360 N
creeps with 0.5 to 0.8 mrad/s; at its tool this is as much as `sleeping_item.STILL`."""
AWAKE, WAKING, ASLEEP, CALLED = 0.0, 1.0, 2.0, 3.0
"""Awake; awake since the last step of the plant; asleep; asleep and told something else."""


class Standing(LeafSystem):
    """Knows for how long the drives' command has been the same, and keeps what touched the arm while it sleeps.

    ```
      desired_state (n) → ┌──────────┐ → actuator_state (m)
    gripper_command (1) → │ Standing │ → contact_results
     actuator_state (m) → │          │ → stage (1)
     contact_results    → └──────────┘
    ```

    The drives' command and the contacts go through. Drake computes no force between bodies that are locked, so while
    the arm sleeps, and until the plant has made the first step after it woke, `contact_results` are those from before:
    what presses, presses on. The drives are not asked then: their command can change only after what they are told
    (`desired_state`, `gripper_command`), and that changes at most once a tick, not with every step of the plant.
    """

    def __init__(self, *, desired: int, actuated: int) -> None:
        """For a `desired_state` of n and an `actuator_state` of m numbers."""
        super().__init__()
        self._told = (
            self.DeclareVectorInputPort("desired_state", desired),
            self.DeclareVectorInputPort("gripper_command", 1),
        )
        self._command = self.DeclareVectorInputPort("actuator_state", actuated)
        self._contacts = self.DeclareAbstractInputPort("contact_results", Value[ContactResults]())
        # The stage, then the drives' command when it was entered.
        self._stage = self.DeclareDiscreteState(1 + actuated)
        # What it was told last, the last command, and since when both have been given [s].
        self._last = self.DeclareDiscreteState(np.full(desired + 1 + actuated + 1, np.nan))
        self._held = self.DeclareAbstractState(Value[ContactResults]())
        # The command depends on the stage, though its value does not: what Drake has cached of the drives' constraints
        # while the joints were free is not to be met again when they are locked (it ends the process, `CalcActuation`).
        stage = self.discrete_state_ticket(self._stage)
        self.DeclareVectorOutputPort("actuator_state", actuated, self._pass_command, {self._command.ticket(), stage})
        # A port, so that Drake knows without asking Python that nothing new was told.
        told = {port.ticket() for port in self._told} | {self.discrete_state_ticket(self._last), stage}
        self._calling = self.DeclareVectorOutputPort("stage", 1, self._calc_stage, told)
        # Drake keeps what computes an abstract port where the garbage collector cannot see it: it must not keep us.
        me = weakref.ref(self)
        self.DeclareAbstractOutputPort(
            "contact_results",
            alloc=lambda: AbstractValue.Make(ContactResults()),
            calc=lambda context, output: me()._pass_contacts(context, output),  # type: ignore[union-attr]
            prerequisites_of_calc={self._contacts.ticket(), stage, self.abstract_state_ticket(self._held)},
        )

    def _pass_command(self, context: Context, output: BasicVector) -> None:
        stage = context.get_discrete_state(self._stage).value()
        output.set_value(stage[1:] if stage.item(0) == ASLEEP else self._command.Eval(context))

    def _calc_stage(self, context: Context, output: BasicVector) -> None:
        stage = context.get_discrete_state(self._stage).value().item(0)
        output.SetAtIndex(0, CALLED if stage == ASLEEP and self._is_told_anew(context) else stage)

    def _pass_contacts(self, context: Context, output: AbstractValue) -> None:
        if context.get_discrete_state(self._stage).value().item(0) == AWAKE:
            output.set_value(self._contacts.Eval(context))
        else:
            output.set_value(context.get_abstract_state(int(self._held)).get_value())

    def stage(self, context: Context) -> float:
        """`AWAKE`, `WAKING`, `ASLEEP` or `CALLED`."""
        return self._calling.Eval(context).item(0)

    def set_stage(self, context: Context, stage: float) -> None:
        """Change it; what touches, and the drives' command, is kept from `ASLEEP` on.

        Args:
            context: of the system.
            stage: see the constants of this module.
        """
        if stage == ASLEEP:
            context.SetAbstractState(int(self._held), self._contacts.Eval(context))
        context.SetDiscreteState(int(self._stage), [stage, *self._command.Eval(context)])

    def stands_for(self, context: Context) -> float:
        """How long the drives have been told and have commanded the same [s], as far as this has been asked."""
        now = context.get_time()
        given = [*self._now_told(context), *self._command.Eval(context).tolist()]
        if given != context.get_discrete_state(self._last).value().tolist()[:-1]:
            context.SetDiscreteState(int(self._last), [*given, now])
        return now - context.get_discrete_state(self._last).value().item(-1)

    def _is_told_anew(self, context: Context) -> bool:
        """Whether the drives are told something else than at the last `stands_for`."""
        told = self._now_told(context)
        return told != context.get_discrete_state(self._last).value().tolist()[: len(told)]

    def _now_told(self, context: Context) -> list[float]:
        desired, gripper = self._told
        return [*desired.Eval(context).tolist(), gripper.Eval(context).item(0)]


class SleepingArm:
    """The arm and its gripper as something that can sleep. Contexts are of the diagram that the plant is in."""

    def __init__(self, plant: MultibodyPlant, robot: ModelInstanceIndex, standing: Standing) -> None:
        self._plant, self._robot, self._standing = plant, robot, standing
        self._joints = [j for j in map(plant.get_joint, plant.GetJointIndices(robot)) if j.num_velocities() > 0]

    def is_awake(self, root: Context) -> bool:
        """Whether it is simulated."""
        return self._standing.stage(self._standing.GetMyContextFromRoot(root)) < ASLEEP

    def look(self, root: Context) -> tuple[bool, bool]:
        """Whether it sleeps, and whether it is called then; to be asked after each step of the plant.

        The first step after it woke is also when it feels again.
        """
        stage = self._standing.stage(self._standing.GetMyContextFromRoot(root))
        if stage == WAKING:
            self._standing.set_stage(self._standing.GetMyMutableContextFromRoot(root), AWAKE)
        return stage >= ASLEEP, stage == CALLED

    def stands(self, root: Context) -> bool:
        """Whether it could sleep, for all that is known of it alone."""
        stands = self._standing.stands_for(self._standing.GetMyMutableContextFromRoot(root)) >= STANDS - 1e-9
        plant_context = self._plant.GetMyContextFromRoot(root)
        return stands and bool(np.abs(self._plant.GetVelocities(plant_context, self._robot)).max() < ARM_STILL)

    def sleep(self, root: Context) -> None:
        """Lock it as it is."""
        self._standing.set_stage(self._standing.GetMyMutableContextFromRoot(root), ASLEEP)
        context = self._plant.GetMyMutableContextFromRoot(root)
        for joint in self._joints:
            joint.Lock(context)

    def wake(self, root: Context) -> None:
        """Let its drives move it again."""
        self._standing.set_stage(self._standing.GetMyMutableContextFromRoot(root), WAKING)
        context = self._plant.GetMyMutableContextFromRoot(root)
        for joint in self._joints:
            joint.Unlock(context)
