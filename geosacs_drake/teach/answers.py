"""What a page says to a lesson."""

from __future__ import annotations

import math

from canal.navigation.joystick import JOYSTICK_PERIOD
from diagrams.teach.jog import SPEED, clean_jog
from geosacs_drake.console.link import Answers
from geosacs_drake.console.messages import Jog, Teach
from geosacs_drake.teach.hand import TeachControl


class TeachAnswers(Answers):
    """Hands jogs and words on to the control."""

    full_stick_mm = 1000 * SPEED * JOYSTICK_PERIOD
    """What a full jog moves in one sample of 20 Hz [mm]."""

    def __init__(self, control: TeachControl) -> None:
        """Answers for `control`."""
        super().__init__()
        self._control = control

    def teach(self, page: str, message: Jog | Teach, age_s: float) -> str:
        """A page jogs the tool, or says a word.

        Args:
            page: that asks.
            message: what it asks for.
            age_s: how old it is, [s].
        """
        if isinstance(message, Teach):
            return self._control.say(page, message.word, age_s)
        jog = clean_jog((*message.move, *message.nose, message.spin))
        if message.mm is None:
            return self._control.drive(page, tuple(jog.tolist()), age_s)
        largest = float(abs(jog).max())
        if largest == 0:
            return ""
        samples = max(1, math.ceil(message.mm / self.full_stick_mm - 1e-9))
        # As far as asked for, in as few samples as do; a turn is as much of its full speed as a motion.
        one = jog / max(math.hypot(*jog[:3]), math.hypot(*jog[3:6]), abs(jog[6])) * message.mm
        return self._control.step(page, [tuple((one / (samples * self.full_stick_mm)).tolist())] * samples, age_s)
