"""A tour of a canal by a scripted thumb: what `learn --plot` and the examples show, with no robot and no clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from canal.navigation.joystick import GRIPPER, JOYSTICK_SIZE, START, in_unit_disc
from canal.navigation.travel import NavigationOptions, initial_state, step
from canal.surface import CanalSurface

RATE_HZ = 100.0
"""[1/s] Steps of a tour."""


@dataclass(frozen=True)
class Push:
    """The stick held off centre.

    Attributes:
        start: when, as a share of the tour's time on the way (0 at home, 1 back at home after pick and place).
        duration: how long, [s].
        stick: k_x, k_y in [-1, 1].
    """

    start: float
    duration: float
    stick: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Tour:
    """What was travelled.

    Attributes:
        position: wanted TCP, [m]. Shape (T, 3).
        disk: continuous disk. Shape (T,).
        eta: ratio. Shape (T,).
        correcting: whether the thumb moved the point. Shape (T,).
    """

    position: np.ndarray
    disk: np.ndarray
    eta: np.ndarray
    correcting: np.ndarray

    @property
    def corrections(self) -> list[np.ndarray]:
        """The corrections as curves, each (k, 3), [m]."""
        return segments(self.position, self.correcting)


DEFAULT_PUSHES = (
    Push(0.10, 0.8, (0.7, 0.6)),
    Push(0.27, 0.7, (-0.8, 0.4)),
    Push(0.60, 0.8, (0.8, -0.5)),
    Push(0.76, 0.6, (-0.3, -0.9)),
)
"""Two corrections on each half of the way: one outwards, which is kept, and one homewards, which fades."""


def tour(
    canal: CanalSurface,
    pushes: Sequence[Push] = DEFAULT_PUSHES,
    options: NavigationOptions | None = None,
) -> Tour:
    """Home, pick, home, place, home once, under a scripted thumb.

    Args:
        canal: the surface.
        pushes: corrections; they stop the way on while they last.
        options: of navigation; by default without waiting at pick and place.
    """
    options = options or NavigationOptions(wait_at_ends=False)
    whole = 2.0 * canal.moving_time_s / options.speed_scale
    pending = sorted(pushes, key=lambda push: push.start)
    state = initial_state(canal)
    joystick = np.zeros(JOYSTICK_SIZE)
    joystick[START] = 1.0
    state = step(canal, state, joystick, 0.0, options=options)
    way, left, rows = 0.0, 0.0, []
    dt = 1.0 / RATE_HZ
    while way < whole:
        joystick = np.zeros(JOYSTICK_SIZE)
        if left <= 0 and pending and way >= pending[0].start * whole:
            push = pending.pop(0)
            left, stick = push.duration, push.stick
        if left > 0:
            joystick[:GRIPPER] = in_unit_disc(*stick)
            left -= dt
        else:
            way += dt
        state = step(canal, state, joystick, dt, options=options)
        rows.append((*canal.point(state.disk, state.eta, state.phi), state.disk, state.eta, state.correcting))
    table = np.array(rows)
    return Tour(table[:, :3], table[:, 3], table[:, 4], table[:, 5] > 0)


def segments(position: np.ndarray, correcting: np.ndarray) -> list[np.ndarray]:
    """The parts of a path (T, 3) in which `correcting` (T,) holds, each from the point where it began.

    Args:
        position: Shape (T, 3).
        correcting: whether a thumb corrected. Shape (T,).

    Returns:
        Parts of the path, each (k, 3).
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(correcting, dtype=int), [0]])))
    return [position[max(0, begin - 1) : end] for begin, end in edges.reshape(-1, 2)]
