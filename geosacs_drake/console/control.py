"""Who steers, and the latest command: one locked value with its time, between the server's thread and Drake's."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from canal.navigation.joystick import GRIPPER, JOYSTICK_SIZE, REVERSE, START, STOP
from diagrams.teleop.live_joystick import LiveSample

STALE_S = 0.150
"""[s] A stick that nobody has confirmed for so long falls to its centre; a press that is older is not carried out."""
MOST_PRESSES = 3
"""Presses of one button that may wait for their sample; more come from something that is broken."""

BUTTONS = {"gripper": GRIPPER, "reverse": REVERSE, "start": START, "stop": STOP}
"""Indices in the joystick vector, by name."""


@dataclass(frozen=True)
class Situation:
    """Who steers, for whoever shows it."""

    holder: str
    """The page in control; empty for none."""
    person: bool
    """Whether a person is in charge, and not the simulated operator."""
    stopped: bool
    """Whether Stop was pressed and Start was not pressed since."""
    begun: bool
    """Whether somebody has said Start or Watch."""


@dataclass
class Control:
    """The latest command of the pages. All methods may be called from any thread.

    A page is named by a text of the server's. Methods that a page calls return what it is to be told where its command
    is not carried out, and an empty text where it is.
    """

    person_asked: bool = False
    """Whether a person is in charge from the beginning."""
    axes: int = 2
    """Of the stick."""
    clock: Callable[[], float] = time.monotonic
    """[s]"""
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def __post_init__(self) -> None:
        self._person = self.person_asked
        self._holder = ""
        self._stopped = False
        self._begun = threading.Event()
        self._centre: tuple[float, ...] = (0.0,) * self.axes
        self._stick, self._stick_time, self._tap = self._centre, -math.inf, self._centre
        self._steps: list[tuple[float, ...]] = []
        self._waiting = dict.fromkeys(BUTTONS, 0)
        self._levels = dict.fromkeys(BUTTONS, False)
        self._sampled = np.zeros(JOYSTICK_SIZE)

    # ---- what pages do ----

    def drive(self, page: str, stick: tuple[float, ...], age_s: float = 0.0) -> str:
        """Hold the stick at `stick` until told otherwise, or until nobody confirms it.

        Args:
            page: that asks.
            stick: right and up; or as many axes as it has.
            age_s: how old the command is, [s].
        """
        with self._lock:
            moved = any(stick)
            if moved and (refusal := self._refusal(page)):
                return refusal
            if page != self._holder or age_s > STALE_S:
                return ""
            if moved:
                self._person = True
                self._tap = stick
            self._stick, self._stick_time = stick, self.clock() - age_s
            return ""

    def step(self, page: str, samples: list[tuple[float, ...]], age_s: float = 0.0) -> str:
        """Move the stick so for as many samples as are given, and centre it then.

        Args:
            page: that asks.
            samples: the stick of each sample of the step.
            age_s: how old the command is, [s].
        """
        with self._lock:
            if refusal := self._refusal(page):
                return refusal
            if age_s > STALE_S:
                return LATE
            self._person = True
            self._steps = list(samples)
            return ""

    def press(self, page: str, button: str, age_s: float = 0.0) -> str:
        """Press a button once. Stop is heard from any page, however late it comes.

        Args:
            page: that asks.
            button: one of `BUTTONS`.
            age_s: how old the command is, [s].
        """
        with self._lock:
            if button == "stop":
                self._stopped = self._person = True
                self._rest()
                self._waiting["stop"] = 1
                return ""
            if refusal := self._refusal(page, start=button == "start"):
                return refusal
            if age_s > STALE_S:
                return LATE
            if self._waiting[button] >= MOST_PRESSES:
                return "Too many presses at once: press again in a moment."
            self._person = True
            if button == "start":
                self._stopped = False
                self._begun.set()
            self._waiting[button] += 1
            return ""

    def take(self, page: str) -> str:
        """Give control to a page, whoever had it; the stick is at its centre then."""
        with self._lock:
            self._holder, self._person = page, True
            self._rest()
            return ""

    def hand_back(self, page: str) -> str:
        """Give the task to the simulated operator, from where it is."""
        with self._lock:
            if self._holder not in ("", page):
                return OTHERS
            if self._stopped:
                return "It is stopped: press Start first, then hand back."
            self._holder, self._person = "", False
            self._rest()
            self._begun.set()
            return ""

    def watch(self) -> str:
        """Let the run begin, with whoever is in charge."""
        self._begun.set()
        return ""

    def leave(self, page: str) -> None:
        """A page has gone: what it held falls to its centre."""
        with self._lock:
            if self._holder == page:
                self._holder = ""
                self._rest()

    # ---- what the run asks ----

    def situation(self) -> Situation:
        """Who steers now."""
        with self._lock:
            return Situation(self._holder, self._person, self._stopped, self._begun.is_set())

    def wait_for_beginning(self, timeout_s: float) -> bool:
        """Wait until somebody says Start or Watch, so long at most; whether somebody has."""
        return self._begun.wait(timeout_s)

    def sample(self) -> LiveSample:
        """What the person's joystick is now, for one sample of 20 Hz: a press is one sample long."""
        with self._lock:
            joystick = np.zeros(JOYSTICK_SIZE)
            joystick[:GRIPPER], pressed = self._take_sample()
            for button, index in BUTTONS.items():
                joystick[index] = float(button in pressed)
            sample = LiveSample(joystick, self._person)
            self._sampled = sample.joystick
            return sample

    @property
    def sampled(self) -> np.ndarray:
        """The joystick of the last sample. Shape (6,)."""
        with self._lock:
            return self._sampled

    # ---- with the lock held ----

    def _take_sample(self) -> tuple[tuple[float, ...], set[str]]:
        """The stick of this sample, and the buttons that are pressed in it."""
        stick = self._centre if self._stopped else self._next_stick()
        self._tap = self._centre
        pressed = set()
        for button in BUTTONS:
            level = self._waiting[button] > 0 and not self._levels[button]
            self._waiting[button] -= level
            self._levels[button] = level
            if level:
                pressed.add(button)
        return stick, pressed

    def _next_stick(self) -> tuple[float, ...]:
        if self._steps:
            return self._steps.pop(0)
        if self.clock() - self._stick_time > STALE_S:
            return self._centre
        # A push that began and ended between two samples is one sample long.
        return self._stick if any(self._stick) else self._tap

    def _refusal(self, page: str, *, start: bool = False) -> str:
        """Why a page may not steer now; empty, and the page in control, where it may."""
        if self._holder not in ("", page):
            return OTHERS
        if self._stopped and not start:
            return "Stopped: nothing moves until Start."
        self._holder = page
        return ""

    def _rest(self) -> None:
        self._stick, self._stick_time, self._tap = self._centre, -math.inf, self._centre
        self._steps = []
        self._waiting = dict.fromkeys(BUTTONS, 0)


OTHERS = "Another page is in control: press Take control first."
LATE = "That press came too late and was not carried out: press again."
"""What a page is told whose command is not carried out."""
