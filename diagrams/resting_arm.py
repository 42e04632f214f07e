"""The arm rests, too: while nobody commands it and nothing near it moves, its joints are locked.

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
creeps with 0.5 to 0.8 mrad/s; at its tool this is as much as `resting_piece.STILL`."""
AWAKE, ASLEEP, WAKING = 0.0, 1.0, 2.0


class Standing(LeafSystem):
    """Knows for how long the drives' command has been the same, and keeps what touched the arm while it sleeps.

    ```
     actuator_state (n) → ┌──────────┐ → actuator_state (n)
     contact_results    → │ Standing │ → contact_results
                          └──────────┘
    ```

    Both go through. Drake computes no force between bodies that are locked, so while the arm sleeps, and until the
    plant has made the first step after it woke, `contact_results` are those from before: what presses, presses on.
    """

    def __init__(self, size: int) -> None:
        """For a command of `size` numbers."""
        super().__init__()
        self._command = self.DeclareVectorInputPort("actuator_state", size)
        self._contacts = self.DeclareAbstractInputPort("contact_results", Value[ContactResults]())
        self._stage = self.DeclareDiscreteState(1)
        # The last command and since when it has been given [s].
        self._last = self.DeclareDiscreteState(np.full(size + 1, np.nan))
        self._held = self.DeclareAbstractState(Value[ContactResults]())
        # The command depends on the stage, though its value does not: what Drake has cached of the drives' constraints
        # while the joints were free is not to be met again when they are locked (it ends the process, `CalcActuation`).
        stage = self.discrete_state_ticket(self._stage)
        self.DeclareVectorOutputPort("actuator_state", size, self._pass_command, {self._command.ticket(), stage})
        # Drake keeps what computes an abstract port where the garbage collector cannot see it: it must not keep us.
        me = weakref.ref(self)
        self.DeclareAbstractOutputPort(
            "contact_results",
            alloc=lambda: AbstractValue.Make(ContactResults()),
            calc=lambda context, output: me()._pass_contacts(context, output),  # type: ignore[union-attr]
            prerequisites_of_calc={self._contacts.ticket(), stage, self.abstract_state_ticket(self._held)},
        )

    def _pass_command(self, context: Context, output: BasicVector) -> None:
        output.set_value(self._command.Eval(context))

    def _pass_contacts(self, context: Context, output: AbstractValue) -> None:
        if self.stage(context) == AWAKE:
            output.set_value(self._contacts.Eval(context))
        else:
            output.set_value(context.get_abstract_state(int(self._held)).get_value())

    def stage(self, context: Context) -> float:
        """`AWAKE`, `ASLEEP`, or `WAKING`: awake since the last step."""
        return context.get_discrete_state(self._stage).value().item()

    def set_stage(self, context: Context, stage: float) -> None:
        """Change it; what touches is kept from `ASLEEP` on."""
        if stage == ASLEEP:
            context.SetAbstractState(int(self._held), self._contacts.Eval(context))
        context.SetDiscreteState(int(self._stage), [stage])

    def is_called(self, context: Context) -> bool:
        """Whether the command is another than at the last `stands_for`."""
        last = context.get_discrete_state(self._last).value().tolist()
        return self._command.Eval(context).tolist() != last[:-1]

    def stands_for(self, context: Context) -> float:
        """How long the command has been what it is [s], as far as this has been asked."""
        now = context.get_time()
        if self.is_called(context):
            context.SetDiscreteState(int(self._last), np.append(self._command.Eval(context), now))
        return now - context.get_discrete_state(self._last).value().item(-1)


class RestingArm:
    """The arm and its gripper as something that can rest. Contexts are of the diagram that the plant is in."""

    def __init__(self, plant: MultibodyPlant, robot: ModelInstanceIndex, standing: Standing) -> None:
        self._plant, self._robot, self._standing = plant, robot, standing
        self._joints = [j for j in map(plant.get_joint, plant.GetJointIndices(robot)) if j.num_velocities() > 0]

    def is_awake(self, root: Context) -> bool:
        """Whether it is simulated."""
        return self._standing.stage(self._standing.GetMyContextFromRoot(root)) != ASLEEP

    def is_called(self, root: Context) -> bool:
        """Whether it sleeps, and is commanded; to be asked after each step of the plant.

        The first step after it woke is also when it feels again.
        """
        context = self._standing.GetMyContextFromRoot(root)
        stage = self._standing.stage(context)
        if stage == WAKING:
            self._standing.set_stage(self._standing.GetMyMutableContextFromRoot(root), AWAKE)
        return stage == ASLEEP and self._standing.is_called(context)

    def stands(self, root: Context) -> bool:
        """Whether it could rest, for all that is known of it alone."""
        stands = self._standing.stands_for(self._standing.GetMyMutableContextFromRoot(root)) >= STANDS - 1e-9
        plant_context = self._plant.GetMyContextFromRoot(root)
        return stands and bool(np.abs(self._plant.GetVelocities(plant_context, self._robot)).max() < ARM_STILL)

    def rest(self, root: Context) -> None:
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
