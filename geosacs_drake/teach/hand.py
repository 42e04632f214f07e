"""The hands that teach: the pages', with their trust, and one that follows a script."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from pydrake.common.yaml import yaml_load
from yaml import YAMLError

from canal.errors import InputError
from canal.navigation.joystick import JOYSTICK_PERIOD
from canal.options import options, read_options
from diagrams.teach.jog import JOG_SIZE
from diagrams.teach.live_jog import TeachSample
from diagrams.teach.path import Word
from geosacs_drake.console.control import LATE, STALE_S, Control

WORDS = {"record": Word.RECORD, "pause": Word.PAUSE, "undo": Word.UNDO, "back": Word.BACK}
"""Of a page, to the recorder."""
MOVING = ("record", "undo", "back", "reset", "travel")
"""After which the robot moves by itself: what comes late is not carried out."""
REQUESTS = ("save", "discard", "reset", "learn", "travel")
"""Of a page, to the lesson."""


@dataclass
class TeachControl(Control):
    """The latest jog of the pages, as `Control` has the latest stick; and what they ask the lesson for."""

    axes: int = JOG_SIZE
    """Of a jog."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._person = True
        self._begun.set()
        self._words: list[Word] = []
        self._requests: list[str] = []

    def say(self, page: str, word: str, age_s: float = 0.0) -> str:
        """A word for the recorder or for the lesson.

        Args:
            page: that says it.
            word: one of `WORDS` or `REQUESTS`.
            age_s: how old it is, [s].
        """
        with self._lock:
            if refusal := self._refusal(page):
                return refusal
            if word in MOVING and age_s > STALE_S:
                return LATE
            if word in WORDS:
                self._words = [WORDS[word]]
            elif word not in self._requests:
                self._requests.append(word)
            return ""

    def jog_sample(self) -> TeachSample:
        """What the hand does now, for one sample of 20 Hz."""
        with self._lock:
            jog, pressed = self._take_sample()
            word = self._words.pop() if self._words else Word.NOTHING
            if "reverse" in pressed:
                word = Word.UNDO
            if self._stopped:
                word = Word.STAND
            return TeachSample(np.array(jog), "gripper" in pressed, word)

    def requests(self) -> list[str]:
        """What was asked of the lesson since it was looked at last."""
        with self._lock:
            asked, self._requests = self._requests, []
            return asked


@options("script", frozen=True)
class ScriptStep:
    """What the hand does for a while.

    Attributes:
        jog: see `diagrams.teach.jog`.
        seconds: how long, [s].
        say: a word at its beginning.
    """

    jog: Annotated[tuple[float, ...], Field(min_length=JOG_SIZE, max_length=JOG_SIZE)] = (0.0,) * JOG_SIZE
    seconds: Annotated[float, Field(gt=0, le=600)] = 0.1
    say: Literal["record", "pause", "undo", "back", "gripper", "save", "discard", "reset", "learn", "travel", ""] = ""


class ScriptedHand:
    """A hand that follows a list of steps, for a lesson with nobody in it."""

    def __init__(self, steps: list[ScriptStep]) -> None:
        self._samples = [
            (np.array(step.jog), step.say if k == 0 else "")
            for step in steps
            for k in range(max(1, round(step.seconds / JOYSTICK_PERIOD)))
        ]
        self._next = 0
        self._requests: list[str] = []

    @property
    def done(self) -> bool:
        """Whether all its steps were taken."""
        return self._next >= len(self._samples)

    def jog_sample(self) -> TeachSample:
        """What it does at the next sample of 20 Hz."""
        if self.done:
            return TeachSample()
        jog, say = self._samples[self._next]
        self._next += 1
        if say in REQUESTS:
            self._requests.append(say)
        return TeachSample(jog, say == "gripper", WORDS.get(say, Word.NOTHING))

    def requests(self) -> list[str]:
        """What was asked of the lesson since it was looked at last."""
        asked, self._requests = self._requests, []
        return asked


def load_script(path: Path) -> ScriptedHand:
    """Read a script: a list of steps, `{jog: [0, 0, -1, 0, 0, 0, 0], seconds: 2}` or `{say: record}`.

    Raises:
        InputError: it does not exist, or is no such list.
    """
    if not path.is_file():
        raise InputError(f"--script {path}: no such file; give a .yaml with steps")
    try:
        steps: Any = yaml_load(filename=str(path))
        if not isinstance(steps, list):
            raise InputError("give a list of steps")
        return ScriptedHand([read_options(ScriptStep, step) for step in steps])
    except InputError as error:
        raise InputError(f"--script {path.name}: {error}") from None
    except (YAMLError, RuntimeError, ValueError, TypeError, OSError) as error:
        raise InputError(f"--script {path.name}: {' '.join(str(error).split())}; give a list of steps") from None
