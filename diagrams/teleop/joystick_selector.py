"""The joystick as systems: one vector, many sources. Here the recorded one, and who of two is in charge."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, DiscreteValues, LeafSystem, OutputPort

from canal.navigation.joystick import JOYSTICK_PERIOD, JOYSTICK_SIZE
from diagrams.teleop.joystick_recording import JoystickRecording


def is_touched(joystick: np.ndarray) -> bool:
    """Whether somebody moves the stick or holds a button."""
    return bool(np.any(joystick))


class RecordedJoystick(LeafSystem):
    """Plays a recording.

    ```
    RecordedJoystick → joystick (6)
                     → person_in_charge (1)
    ```

    Each 20 Hz sample takes what the recording held in the middle of it, so that the samples of a log, or rows written
    at 40 Hz or more before or after the sample's update, give back that run bit for bit. `person_in_charge` is 1 where
    a person held the joystick when it was recorded.
    """

    def __init__(self, recording: JoystickRecording, period: float = JOYSTICK_PERIOD) -> None:
        """Play `recording`, sampled every `period` seconds."""
        super().__init__()
        self._recording = recording
        self._period = period
        self.DeclareStateOutputPort("joystick", self.DeclareDiscreteState(JOYSTICK_SIZE))
        self.DeclareStateOutputPort("person_in_charge", self.DeclareDiscreteState([recording.person_at(0.0)]))
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._sample)

    @staticmethod
    def AddToBuilder(
        *, builder: DiagramBuilder, recording: JoystickRecording, name: str = "recorded_joystick"
    ) -> RecordedJoystick:
        """Add a source that plays `recording` to `builder`.

        Args:
            builder: of the diagram that it is added to.
            recording: that is played.
            name: of the system.
        """
        return builder.AddNamedSystem(name, RecordedJoystick(recording))

    def _sample(self, context: Context, discrete: DiscreteValues) -> None:
        middle = context.get_time() + self._period / 2
        discrete.set_value(0, self._recording.at(middle))
        discrete.set_value(1, [self._recording.person_at(middle)])


class JoystickSelector(LeafSystem):
    """Lets a person take over from the simulated operator by touching the joystick.

    ```
                      person (6) → ┌──────────────────┐
            person_in_charge (1) → │                  │
                   simulated (6) → │ JoystickSelector │ → joystick (6)
    simulated_person_in_charge (1)→└──────────────────┘ → person_in_charge (1)
    ```

    Until the person's stick leaves its centre or a button is pressed, `joystick` is `simulated`; from then on it is
    `person`, once and for all. Where the input `person_in_charge` is connected, it alone says who it is, and a person
    can hand back. The output of that name is 1 while it is the person, and else what `simulated_person_in_charge` says
    of a recording (0 if that is unconnected). An unconnected `person` never takes over; an unconnected `simulated`
    rests.
    """

    def __init__(self, period: float = JOYSTICK_PERIOD) -> None:
        """Look at the person's joystick every `period` seconds."""
        super().__init__()
        self._person = self.DeclareVectorInputPort("person", JOYSTICK_SIZE)
        self._said = self.DeclareVectorInputPort("person_in_charge", 1)
        self._simulated = self.DeclareVectorInputPort("simulated", JOYSTICK_SIZE)
        self._recorded = self.DeclareVectorInputPort("simulated_person_in_charge", 1)
        self._latch = self.DeclareDiscreteState(1)
        prerequisites = {
            self.discrete_state_ticket(self._latch),
            self._person.ticket(),
            self._said.ticket(),
            self._simulated.ticket(),
        }
        self.DeclareVectorOutputPort("joystick", JOYSTICK_SIZE, self._calc_joystick, prerequisites)
        self.DeclareVectorOutputPort(
            "person_in_charge",
            1,
            self._calc_in_charge,
            {
                self.discrete_state_ticket(self._latch),
                self._person.ticket(),
                self._said.ticket(),
                self._recorded.ticket(),
            },
        )
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        person: OutputPort | None = None,
        person_in_charge: OutputPort | None = None,
        simulated: OutputPort | None = None,
        simulated_person_in_charge: OutputPort | None = None,
        name: str = "joystick_selector",
    ) -> JoystickSelector:
        """Add a selector to `builder`, connected to the sources that there are.

        Args:
            builder: of the diagram that it is added to.
            person: port of a person's joystick.
            person_in_charge: port that says whether the person has the robot.
            simulated: port of the simulated operator's or a recorded joystick.
            simulated_person_in_charge: port that says whether a person held it when it was recorded.
            name: of the system.
        """
        selector = builder.AddNamedSystem(name, JoystickSelector())
        for source, port in (
            (person, "person"),
            (person_in_charge, "person_in_charge"),
            (simulated, "simulated"),
            (simulated_person_in_charge, "simulated_person_in_charge"),
        ):
            if source is not None:
                builder.Connect(source, selector.GetInputPort(port))
        return selector

    def _person_joystick(self, context: Context) -> np.ndarray:
        if not self._person.HasValue(context):
            return np.zeros(JOYSTICK_SIZE)
        joystick: np.ndarray = self._person.Eval(context)
        return joystick

    def _in_charge(self, context: Context) -> bool:
        if self._said.HasValue(context):
            return self._said.Eval(context).item(0) > 0.5
        # The touch counts in the very sample that shows it; the state only remembers it.
        latched = context.get_discrete_state(self._latch).value().item(0) > 0.5
        return latched or is_touched(self._person_joystick(context))

    def _update(self, context: Context, discrete: DiscreteValues) -> None:
        discrete.set_value(0, np.array((float(self._in_charge(context)),)))

    def _calc_joystick(self, context: Context, output: BasicVector) -> None:
        if self._in_charge(context):
            output.set_value(self._person_joystick(context))
        elif self._simulated.HasValue(context):
            output.set_value(self._simulated.Eval(context))
        else:
            output.set_value(np.zeros(JOYSTICK_SIZE))

    def _calc_in_charge(self, context: Context, output: BasicVector) -> None:
        recorded = self._recorded.HasValue(context) and self._recorded.Eval(context).item(0) > 0.5
        output.SetAtIndex(0, float(recorded or self._in_charge(context)))
