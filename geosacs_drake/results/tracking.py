"""How well and how late the arm follows what is wanted of it, from the log of a run."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.optimize import minimize_scalar

from canal.rows import rows_between

LONGEST_DELAY_S = 0.5
"""Where the delay is looked for: drives that lag by more follow nothing."""
LEAST_WAY_M = 0.01
"""Without so much motion wanted there is no delay to be seen."""
ARM_TICKS = 2
"""Control periods from when a pose is wanted until the arm is to be there: the IK takes it up a tick later, and the
drives are there at the end of that tick."""


class Tracking:
    """Wanted and measured tool positions of a run, on one clock.

    Attributes:
        wanted_at: when the navigator wanted each pose [s]. Shape (T - 1,).
        wanted: the positions [m]. Shape (T - 1, 3).
        measured_at: [s]. Shape (T,).
        measured: [m]. Shape (T, 3).
        running: whether the robot was started, at each `wanted_at`. Shape (T - 1,).
        delay_s: from when a pose is wanted until the arm is there; None where too little was wanted to tell.
    """

    def __init__(self, signals: Mapping[str, np.ndarray], running: np.ndarray) -> None:
        """Take what is needed of a log.

        Args:
            signals: `time` (T,), `X_BT` (T, 7) and `X_BT_desired` (T, 7) as `diagrams.run_log` has them: a row's wanted
                pose is of the tick before.
            running: of each row. Shape (T,).
        """
        self.measured_at, self.measured = signals["time"], signals["X_BT"][:, :3]
        self.wanted_at, self.wanted = signals["time"][:-1], signals["X_BT_desired"][1:, :3]
        self.running = np.asarray(running, dtype=bool)[1:]
        self.delay_s = self._delay()

    def _arm_at(self, times: np.ndarray) -> np.ndarray:
        """Where the tool was at `times` (m,) [s]. Shape (m, 3)."""
        return rows_between(self.measured, times, self.measured_at)

    def _delay(self) -> float | None:
        """The shift in time that brings what was measured nearest to what was wanted, in the mean of squares."""
        steps = np.linalg.norm(np.diff(self.wanted[self.running], axis=0), axis=1)
        if steps.sum() < LEAST_WAY_M:
            return None
        # To the end of what was measured, whatever the shift.
        used = self.running & (self.wanted_at <= self.measured_at[-1] - LONGEST_DELAY_S)
        if not used.any():
            return None

        def miss(delay: float) -> float:
            return float(((self._arm_at(self.wanted_at[used] + delay) - self.wanted[used]) ** 2).sum())

        rough = np.linspace(0.0, LONGEST_DELAY_S, 26)
        best = rough[np.argmin([miss(delay) for delay in rough])]
        step = rough[1]
        found = minimize_scalar(miss, bounds=(max(best - step, 0.0), best + step), method="bounded")
        return float(found.x)

    def errors(self) -> np.ndarray:
        """Distance [m] of the tool at each tick of a started run from the pose whose command ends then. Shape (m,)."""
        arm = self.measured[ARM_TICKS:]
        wanted = self.wanted[: len(arm)]
        return np.linalg.norm(arm - wanted, axis=1)[self.running[: len(arm)]]

    def way(self, wanted: np.ndarray) -> float:
        """Length of the arm's way [m] in answer to some of the steps that were wanted.

        Args:
            wanted: of each `wanted_at`, whether the step that ended in it counts. Shape (T - 1,).
        """
        period = np.diff(self.measured_at[:2]).sum()
        delay = ARM_TICKS * period if self.delay_s is None else self.delay_s
        steps = np.linalg.norm(np.diff(self._arm_at(self.wanted_at + delay), axis=0), axis=1)
        return float(steps[np.asarray(wanted, dtype=bool)[1:]].sum())
