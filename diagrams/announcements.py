"""What a person is told while the robot runs: one line at each change, for a terminal, a page, a console."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, LeafSystem

from canal.navigation import FIELD_NAMES, Ignored, NavigationState, initial_state
from canal.navigation.joystick import JOYSTICK_PERIOD
from canal.surface import CanalSurface


class Event(StrEnum):
    """What has happened."""

    PRESSES = "presses"
    """A contact force is above its limit."""
    FREE = "free"
    """No contact force is above its limit any more."""
    STOPPED = "stopped"
    """The run was stopped; nothing moves until Start."""
    PAUSED = "paused"
    """The travel was paused on its disk."""
    GOES_ON = "goes on"
    """The travel goes on after a stop or a pause."""
    IGNORED = "ignored"
    """A press did nothing."""


@dataclass(frozen=True)
class Announcement:
    """One line for a person.

    Attributes:
        time_s: when [s].
        event: what has happened.
        text: the same in words, with what to do about it.
        force_n: with which force the robot presses [N]; 0 where it does not.
    """

    time_s: float
    event: Event
    text: str
    force_n: float = 0.0


STOPPED = "Stopped: nothing moves until Start."
PAUSED = "Paused on its disk: stick, gripper and Reverse work, Start goes on."
SHOWN_S = 4.0
"""[s] How long it is shown that a press has done nothing."""
WHY_IGNORED = {
    Ignored.STOPPED: "It has been stopped: nothing moves until Start.",
    Ignored.ALREADY_STOPPED: "It stands already: Start goes on.",
    Ignored.STOP_HELD: "Stop is still held: let go of it, then press Start.",
    Ignored.WAITING: "It waits at the end of the canal: the gripper or Reverse goes on.",
    Ignored.PRESSING: "It cannot go on while it presses: Reverse leads back, the stick leads away.",
    Ignored.POINT: "The canal is as narrow as a point here: there is nothing to correct.",
}
"""What a person is told whose press did nothing."""


def body_in_words(name: str) -> str:
    """A body of the robot as a person calls it: `lio_finger_left` is the left finger."""
    words = name.removeprefix("lio_").split("_")
    if words[-1] in ("left", "right"):
        words = [words[-1], *words[:-1]]
    return " ".join(words)


def changes(before: NavigationState, now: NavigationState) -> list[tuple[Event, str]]:
    """What is to be told after a step from one navigation state to another, but for what presses.

    Args:
        before: the step.
        now: after it.
    """
    found = []
    if before.alarm and not now.alarm:
        found.append((Event.FREE, "It does not press any more, and goes on as told."))
    if before.running and not now.running:
        found.append((Event.STOPPED, STOPPED))
    if now.running and before.paused != now.paused:
        found.append((Event.PAUSED, PAUSED) if now.paused else (Event.GOES_ON, "It goes on."))
    if now.ignored > before.ignored:
        found.append((Event.IGNORED, WHY_IGNORED[Ignored(int(now.ignored_why))]))
    return found


def status(now: NavigationState, pressing: str, ignored_lately: bool) -> str:
    """What is to be seen as long as it holds; empty while all goes its way.

    Args:
        now: of the navigation.
        pressing: what presses on what, in words.
        ignored_lately: whether a press has done nothing a moment ago.
    """
    if ignored_lately:
        return WHY_IGNORED[Ignored(int(now.ignored_why))]
    if now.alarm:
        return pressing
    if not now.running:
        return "" if now.held_start == 0 and now.travelled == 0 else STOPPED
    return PAUSED if now.paused else ""


class Announcer(LeafSystem):
    """Says what changes, and shows what lasts.

    ```
           navigation_state → ┌───────────┐
     contact_forces (pairs) → │ Announcer │
    touching_bodies (pairs) → └───────────┘
    ```

    It looks 20 times a second. The state is what it has told: the navigation state, and then the force, the pair and
    the body that pressed when the alarm rose, the time of the last press that did nothing, and of the last look.
    """

    def __init__(
        self,
        *,
        canal: CanalSurface,
        contact_pairs: Sequence[str],
        robot_bodies: Sequence[str],
        limit_n: float,
        say: Callable[[Announcement], None] | None = None,
        show: Sequence[Callable[[str, str, float], None]] = (),
    ) -> None:
        """Tell of a run. What is called must not raise.

        Args:
            canal: that is travelled.
            contact_pairs: names of the pairs, `lio-NAME`.
            robot_bodies: names of the bodies that `touching_bodies` counts.
            limit_n: of a contact force [N].
            say: gets each announcement.
            show: each gets the text that is shown, the one to show from now on (empty: none) and the time [s].
        """
        super().__init__()
        self._pairs, self._bodies = list(contact_pairs), list(robot_bodies)
        self._limit_n = limit_n
        self._say, self._show = say, show
        self._navigation = self.DeclareVectorInputPort("navigation_state", len(FIELD_NAMES))
        self._forces = self.DeclareVectorInputPort("contact_forces", len(self._pairs))
        self._touching = self.DeclareVectorInputPort("touching_bodies", len(self._pairs))
        self._told = self.DeclareDiscreteState(initial_state(canal).to_vector())
        self._details = self.DeclareDiscreteState([0.0, 0.0, 0.0, -np.inf, 0.0])
        self.DeclarePeriodicDiscreteUpdateEvent(JOYSTICK_PERIOD, 0.0, self._look)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, name: str = "announcer", **kwargs: Any) -> Announcer:
        """Add an announcer to `builder`; `kwargs` as for the constructor.

        Args:
            builder: of the diagram that it is added to.
            name: of the system.
            **kwargs: as for the constructor.
        """
        return builder.AddNamedSystem(name, Announcer(**kwargs))

    def _look(self, context: Context, discrete: DiscreteValues) -> None:
        told = NavigationState.from_vector(context.get_discrete_state(self._told).value())
        details = context.get_discrete_state(self._details).value()
        now, time = NavigationState.from_vector(self._navigation.Eval(context)), context.get_time()
        new = details.copy()
        new[4] = time
        found = changes(told, now)
        if now.alarm and not told.alarm:
            forces = self._forces.Eval(context)
            pair = int(np.argmax(forces))
            new[:3] = forces[pair], pair, self._touching.Eval(context)[pair]
            found.insert(0, (Event.PRESSES, self._pressing(new)))
        if now.ignored > told.ignored:
            new[3] = time
        for event, text in found if self._say is not None else []:
            self._say(Announcement(time, event, text, float(new[0]) if event is Event.PRESSES else 0.0))  # type: ignore[misc]
        before, after = self._status(told, details), self._status(now, new)
        if before != after:
            for show in self._show:
                show(before, after, time)
        discrete.set_value(self._told, now.to_vector())
        discrete.set_value(self._details, new)

    def _status(self, state: NavigationState, details: np.ndarray) -> str:
        return status(state, self._pressing(details), bool(details[4] - details[3] < SHOWN_S))

    def _pressing(self, details: np.ndarray) -> str:
        force, pair, body = float(details[0]), int(details[1]), int(details[2])
        return (
            f"The {body_in_words(self._bodies[body])} presses on the {self._pairs[pair].partition('-')[2]} with "
            f"{force:.0f} N (limit {self._limit_n:g} N): it goes no further that way. Reverse leads back, the stick "
            "leads away, the gripper works."
        )
