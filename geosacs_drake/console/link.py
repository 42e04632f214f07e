"""One page's link: its messages become commands, and how late they come is measured."""

from __future__ import annotations

import json
import math
from collections.abc import Callable

from geosacs_drake.console.bindings import BindingFiles
from geosacs_drake.console.control import Control
from geosacs_drake.console.mapping_choice import MappingChoice
from geosacs_drake.console.messages import (
    AnyMessage,
    Bindings,
    Drive,
    Jog,
    Look,
    Press,
    Say,
    Seen,
    Step,
    Teach,
    View,
)

NO_PICTURES = "There is no camera on the gripper here: it needs the system's libEGL."
"""What a page is told that looks in vain."""


class Link:
    """What is known of a page.

    Attributes:
        last: number of its last message.
        looks: whether it waits for a picture of the gripper's camera.
        delay_ms: how long a status takes to be seen there, there and back.
    """

    def __init__(self, name: str, control: Control, answers: Answers) -> None:
        """A link of the page `name`; what is no command of the stick goes to `answers`."""
        self.name, self.control, self.answers = name, control, answers
        self.last, self.looks = -1, False
        self.delay_ms = math.nan
        self._ahead = math.inf
        self._told: dict[int, float] = {}

    def tell(self, number: int, now_s: float) -> None:
        """Remember when a status was sent.

        Args:
            number: of the status.
            now_s: when it was sent, [s].
        """
        self._told[number] = now_s
        if len(self._told) > 200:
            del self._told[next(iter(self._told))]

    def receive(self, message: AnyMessage, now_s: float) -> str:
        """Carry out a message that came at `now_s`; what the page is told, empty for nothing.

        Args:
            message: as it was read.
            now_s: when it came, [s].
        """
        self.last = message.n
        age_s = self._age(message.t, now_s)
        text = self._carry_out(message, age_s, now_s)
        return json.dumps({"type": "told", "n": message.n, "text": text}) if text else ""

    def _age(self, page_ms: float, now_s: float) -> float:
        """How much longer than the fastest one a message took: the clocks agree on nothing else. [s]"""
        ahead = now_s - page_ms / 1000
        self._ahead = min(self._ahead, ahead)
        return ahead - self._ahead

    def _carry_out(self, message: AnyMessage, age_s: float, now_s: float) -> str:
        control = self.control
        match message:
            case Drive(stick=stick):
                return control.drive(self.name, stick, age_s)
            case Press(button=button):
                return control.press(self.name, button, age_s)
            case Step(direction=direction, mm=mm):
                return control.step(self.name, self.answers.step_samples(direction, mm), age_s)
            case Say(type="take"):
                return control.take(self.name)
            case Say(type="hand_back"):
                return control.hand_back(self.name)
            case Say(type="watch"):
                return control.watch()
            case Seen(status=number):
                if number in self._told:
                    self.delay_ms = 1000 * (now_s - self._told.pop(number))
                return ""
            case Look():
                self.looks = self.answers.shows_pictures
                return "" if self.looks else NO_PICTURES
            case View() if control.situation().holder not in ("", self.name):
                return ""
            case View():
                return self.answers.change_view(self.name, message)
            case Bindings(name=name, bindings=bindings):
                return self.answers.keep_bindings(name, bindings)
            case Jog() | Teach():
                return self.answers.teach(self.name, message, age_s)
            case Say(type=word):
                return self.answers.word(self.name, word)
        return ""


class Answers:
    """What a run does with the messages that are no commands of the stick; this one does nothing with them."""

    full_stick_mm: float = 20.0 / 150.0 * 50.0
    """What a full stick moves in one sample of 20 Hz [mm]."""
    shows_pictures: bool = False
    """Whether the gripper's camera is there."""
    mapping: MappingChoice | None = None
    """Gets the pages' choices."""

    def __init__(self, bindings: BindingFiles | None = None) -> None:
        self.bindings = bindings or BindingFiles()

    on_word: Callable[[str, str], str] = staticmethod(lambda page, word: "")
    """Called with the page and its word; returns what the page is told."""

    def step_samples(self, direction: tuple[float, float], mm: float) -> list[tuple[float, ...]]:
        """Sticks that move the point `mm` in a direction, one a sample: equal ones, as few as do.

        Args:
            direction: right and up.
            mm: how far, [mm].
        """
        norm = math.hypot(*direction)
        if norm == 0:
            return []
        samples = max(1, math.ceil(mm / self.full_stick_mm - 1e-9))
        k = mm / (self.full_stick_mm * samples * norm)
        return [(k * direction[0], k * direction[1])] * samples

    def change_view(self, page: str, view: View) -> str:
        """A page has chosen how the stick is mapped: the one in control, or any where nobody is.

        Args:
            page: that asks.
            view: what it asks for.
        """
        if self.mapping is not None:
            self.mapping.choose(view.mapping, view.seat, view.right, view.up, follow=view.follow)
        return ""

    def teach(self, page: str, message: Jog | Teach, age_s: float) -> str:
        """A page teaches; here nothing is taught.

        Args:
            page: that asks.
            message: what it asks for.
            age_s: how old it is, [s].
        """
        return "Here the robot is steered, not taught: load this page again."

    def keep_bindings(self, name: str, bindings: dict) -> str:
        """A page wants the bindings of a device kept.

        Args:
            name: of the file.
            bindings: what is kept.
        """
        return self.bindings.keep(name, bindings)

    def word(self, page: str, word: str) -> str:
        """Another word of a page.

        Args:
            page: that asks.
            word: what it says.
        """
        return self.on_word(page, word)
