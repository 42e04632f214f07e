"""What the page shows, taken from the run's Context twenty times a second of the clock on the wall."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from pydrake.systems.framework import Context

from canal.navigation import Leg, NavigationState, leg_end, phase
from canal.navigation.joystick import GRIPPER
from canal.surface import CanalSurface
from diagrams.shared_autonomy import SharedAutonomy
from geosacs_drake.console.control import Control
from geosacs_drake.console.words import LEGS, doing, start_word

PERIOD_S = 0.05
"""[s]"""
RATE_OVER_S = 2.0
"""[s] The real-time factor is that of so long."""


class StatusReporter:
    """Reads a run. Called after each step of the plant, it looks at the clock and does nothing most of the time."""

    def __init__(
        self,
        *,
        system: SharedAutonomy,
        canal: CanalSurface,
        item_names: list[str],
        control: Control,
        show: Callable[[dict[str, Any]], None],
        standing: Callable[[], str],
    ) -> None:
        """Report `system`.

        Args:
            system: the run.
            canal: that it travels.
            item_names: of the items, in the scenario's order.
            control: who steers.
            show: gets each status.
            standing: what an announcer has to say at the moment.
        """
        self._system, self._canal, self._names, self._control = system, canal, item_names, control
        self._show, self._standing = show, standing
        self._next = 0.0
        self._clock: deque[tuple[float, float]] = deque()
        self._started = -1.0

    def __call__(self, root: Context) -> None:
        """Report, if it is time to."""
        now = time.perf_counter()
        if now >= self._next:
            self._next = now + PERIOD_S
            self._show(self.status(root, now))

    def status(self, root: Context, now_s: float) -> dict[str, Any]:
        """The status as plain data; `now_s` is the time on the wall [s].

        Args:
            root: the diagram's context.
            now_s: when, on the wall's clock, [s].
        """
        system, canal = self._system, self._canal
        navigator = system.navigator.GetMyContextFromRoot(root)
        state = system.navigator.state(navigator)
        situation = self._control.situation()
        headline, sentence, tone = doing(
            state, self._standing(), person=situation.person, begun=situation.begun or root.get_time() > 0
        )
        time_s = root.get_time()
        if state.running and self._started < 0:
            self._started = time_s
        task_s = time_s - self._started if self._started >= 0 else 0.0
        x, y = canal.axes(state.disk)
        monitor = system.monitor.GetMyContextFromRoot(root)
        placed = system.monitor.GetOutputPort("placed_times").Eval(monitor)
        leg = Leg(int(state.leg))
        joystick = system.selector.GetOutputPort("joystick").Eval(system.selector.GetMyContextFromRoot(root))
        return {
            "time_s": round(time_s, 2),
            "headline": headline,
            "sentence": sentence,
            "tone": tone,
            "start": start_word(state),
            "leg": LEGS[leg],
            "progress": round(_progress(canal, state, leg), 4),
            "phase": round(phase(canal, state.disk), 4),
            "eta": round(state.eta, 4),
            "phi": round(state.phi, 4),
            "radius_mm": round(1000 * canal.radius(state.disk), 1),
            "axes": [[round(v, 4) for v in axis.tolist()] for axis in (x, y)],
            "correcting": bool(state.correcting),
            "corrections": int(state.corrections),
            "correction_s": round(state.correction_time_s, 2),
            "correction_mm": round(1000 * state.correction_distance_m, 1),
            "task_s": round(task_s, 2),
            "closed": bool(state.gripper_closed),
            "running": bool(state.running),
            "paused": bool(state.paused),
            "waiting": bool(state.waiting),
            "alarm": bool(state.alarm),
            "stick": [round(v, 3) for v in joystick[:GRIPPER].tolist()],
            "items": [{"name": n, "placed": bool(t >= 0)} for n, t in zip(self._names, placed, strict=True)],
            "rate": self._rate(now_s, time_s),
        }

    def _rate(self, now_s: float, time_s: float) -> float | None:
        clock = self._clock
        clock.append((now_s, time_s))
        while clock[-1][0] - clock[0][0] > RATE_OVER_S:
            clock.popleft()
        elapsed = clock[-1][0] - clock[0][0]
        return round((clock[-1][1] - clock[0][1]) / elapsed, 3) if elapsed > RATE_OVER_S / 4 else None


def _progress(canal: CanalSurface, state: NavigationState, leg: Leg) -> float:
    """Share of the leg that lies behind."""
    end = leg_end(canal, leg)
    begin = canal.home_disk if not leg.homeward else leg_end(canal, leg.reversed)
    whole = end - begin
    return min(max((state.disk - begin) / whole, 0.0), 1.0) if whole and math.isfinite(whole) else 0.0
