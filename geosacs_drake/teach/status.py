"""What the teaching page shows, taken from the lesson's Context."""

from __future__ import annotations

import time
from collections import deque
from typing import Any

from pydrake.systems.framework import Context
from scipy.spatial.transform import Rotation

from diagrams.teach.path import TaughtPath
from diagrams.teaching import Teaching
from geosacs_drake.console.status import PERIOD_S, RATE_OVER_S
from geosacs_drake.teach.lesson import Lesson

HELD_S = 0.2
"""[s] An arm that has not followed for so long does not: it may wait for a moment where a joint is at its speed."""


def describe(path: TaughtPath, lesson: Lesson, *, stopped: bool, presses: bool, held: bool) -> tuple[str, str, str]:
    """What the robot is doing, and what the person can do.

    Args:
        path: that is taught.
        lesson: what was taught before.
        stopped: whether Stop holds.
        presses: whether it presses on something.
        held: whether the arm cannot follow the hand.

    Returns:
        A headline, a sentence about it, and its tone: `ready`, `go`, `steer`, `wait` or `stop`.
    """
    if stopped:
        return "Stopped", "Nothing moves until Start.", "stop"
    if path.leads_back:
        return "Going back", "The way it came. Any push of the stick ends it.", "go"
    if presses:
        return "It presses on something", "Move away from it, or press Undo: it goes back the way it came.", "stop"
    if held:
        return "The arm reaches no further", "Move it another way, or turn the gripper.", "wait"
    if path.recording:
        return "Recording", f"{path.duration_s:.1f} s of motion. Standing still takes no time.", "steer"
    if path.kept:
        return "Paused", "Go on records from where it paused. Save keeps the demonstration.", "wait"
    if lesson.canal is not None:
        return "The canal is learned", "It is drawn in blue. Travel drives the robot along it.", "go"
    saved = len(lesson.files)
    if saved == 0:
        return (
            "Move to where it begins",
            "Bring the gripper to what is picked up. Then press Record.",
            "ready",
        )
    if saved == 1:
        return "One more", "Go back to the beginning, and show it again, a little differently.", "ready"
    return "Ready to learn", f"{saved} demonstrations are saved. Learn makes the canal; more make it wider.", "ready"


class TeachReporter:
    """Reads a lesson twenty times a second of the clock on the wall."""

    def __init__(self, teaching: Teaching, lesson: Lesson) -> None:
        self._teaching, self._lesson = teaching, lesson
        self._next = 0.0
        self._clock: deque[tuple[float, float]] = deque()

    def due(self) -> bool:
        """Whether it is time for another status."""
        now = time.perf_counter()
        if now < self._next:
            return False
        self._next = now + PERIOD_S
        return True

    def status(self, root: Context, *, stopped: bool, busy: str = "") -> dict[str, Any]:
        """The status as plain data.

        Args:
            root: the diagram's context.
            stopped: whether Stop holds.
            busy: what the lesson is doing instead of moving the robot; empty for nothing.
        """
        system, lesson = self._teaching, self._lesson
        path = system.recorder.path(root)

        def value(part: Any, port: str) -> Any:
            return part.GetOutputPort(port).Eval(part.GetMyContextFromRoot(root))

        X_BT = value(system.station, "X_BT")
        presses = bool(value(system.alarm, "alarm")[0] > 0)
        held = bool(value(system.jog, "waited")[0] > HELD_S)
        headline, sentence, tone = describe(path, lesson, stopped=stopped, presses=presses, held=held)
        if busy:
            headline, sentence, tone = busy, "One moment.", "wait"
        R_BT = Rotation.from_quat(X_BT[3:], scalar_first=True).as_matrix()
        return {
            "teaching": True,
            "time_s": round(root.get_time(), 2),
            "headline": headline,
            "sentence": sentence,
            "tone": tone,
            "closed": bool(value(system.hand, "gripper_command")[0] > 0.5),
            "recording": path.recording or path.then_record,
            "leads_back": path.leads_back,
            "kept_s": round(path.duration_s, 1),
            "way_back": len(path.poses) > 1,
            "saved": [{"name": d.name, "s": round(d.duration, 1)} for d in lesson.demonstrations],
            "learned": lesson.canal is not None,
            "busy": bool(busy),
            "tool": [round(v, 3) for v in X_BT[:3].tolist()],
            "R_BT": [[round(v, 4) for v in row] for row in R_BT.tolist()],
            "rate": self._rate(root.get_time()),
        }

    def _rate(self, time_s: float) -> float | None:
        clock, now = self._clock, time.perf_counter()
        if clock and time_s < clock[-1][1]:
            clock.clear()
        clock.append((now, time_s))
        while clock[-1][0] - clock[0][0] > RATE_OVER_S:
            clock.popleft()
        elapsed = clock[-1][0] - clock[0][0]
        return round((clock[-1][1] - clock[0][1]) / elapsed, 3) if elapsed > RATE_OVER_S / 4 else None
