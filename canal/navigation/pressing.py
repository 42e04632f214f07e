"""What may move while the robot presses on something: not further in; the way back is free.

The alarm is a level: it lasts while a contact force is above its limit. The direction that presses is against the net
force on the hand, where the contacts agree on one. Where they do not (a wedged hand, a contact of the arm, whose force
says nothing about the tool), what moved when the force rose is what presses.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from canal.navigation.state import NavigationState
from canal.surface import CanalSurface

DECISIVE = 0.5
"""Share of the contact's force that the net force on the hand must reach to tell a direction: of two opposite contacts,
one is then at least three times as strong as the other."""
GLANCING = 0.05
"""Sine of the angle to the touched surface (3°) below which a motion runs along it and does not press."""

ALONG = 0.5
"""[disks] Each way from the point, to tell the direction of the canal there."""


def feel(
    canal: CanalSurface, state: NavigationState, stick: tuple[float, float], alarm: float, force: Sequence[float]
) -> NavigationState:
    """The state after a look at the forces.

    Args:
        canal: that is travelled.
        state: before anything has moved or been pressed in this step.
        stick: k_x, k_y.
        alarm: force of the contact whose force is above its limit [N]; 0 for none.
        force: net force on the hand in the robot's base frame [N]. Shape (3,).

    Returns:
        The state with `alarm`, and with the direction that presses as far as it is known.
    """
    if not alarm > 0:
        if not state.alarm:
            return state
        return replace(state, alarm=0.0, press_x=0.0, press_y=0.0, press_z=0.0, press_way=0.0)
    size = math.hypot(*force)
    if math.isfinite(size) and size > 0 and size >= DECISIVE * alarm:
        f_x, f_y, f_z = (float(f) / size for f in force)
        state = replace(state, press_x=-f_x, press_y=-f_y, press_z=-f_z)
    if state.alarm:
        return state
    if not state.correcting:
        return replace(state, alarm=1.0, press_way=state.travelled)
    if _press(state) == (0.0, 0.0, 0.0):
        norm = math.hypot(*stick)
        if norm == 0:
            return replace(state, alarm=1.0, press_way=state.travelled)
        x, y = canal.axes(state.disk)
        p_x, p_y, p_z = ((stick[0] * x + stick[1] * y) / norm).tolist()
        state = replace(state, press_x=p_x, press_y=p_y, press_z=p_z)
    return replace(state, alarm=1.0)


def presses_along(canal: CanalSurface, state: NavigationState, way: int) -> bool:
    """Whether a travel in the direction `way` (±1) presses. Never true of both ways.

    Args:
        canal: that is travelled.
        state: where the robot is, and what presses.
        way: +1 towards place, -1 towards pick.
    """
    if not state.alarm:
        return False
    # Of the chord around the point, so that what one way presses the other relieves, at any kink.
    ahead = canal.point(state.disk + ALONG, state.eta, state.phi)
    behind = canal.point(state.disk - ALONG, state.eta, state.phi)
    chord = (ahead - behind).tolist()
    into = way * sum(c * p for c, p in zip(chord, _press(state), strict=True))
    if abs(into) <= GLANCING * math.hypot(*chord):
        return way == state.press_way
    return bool(into > 0)


def cut_stick(canal: CanalSurface, state: NavigationState, stick: tuple[float, float]) -> tuple[float, float]:
    """The stick without the part that presses.

    Args:
        canal: that is travelled.
        state: where the robot is, and what presses.
        stick: k_x and k_y.

    Returns:
        k_x and k_y of what is left.
    """
    if not state.alarm:
        return stick
    x, y = canal.axes(state.disk)
    a_x, a_y = (sum(p * a for p, a in zip(_press(state), axis.tolist(), strict=True)) for axis in (x, y))
    into, squared = stick[0] * a_x + stick[1] * a_y, a_x * a_x + a_y * a_y
    if into <= 0 or squared <= GLANCING * GLANCING:
        return stick
    return stick[0] - into / squared * a_x, stick[1] - into / squared * a_y


def presses(state: NavigationState, moved: Sequence[float]) -> bool:
    """Whether a displacement of the tool [m] in the base frame presses. Shape (3,).

    Args:
        state: what presses.
        moved: in B, [m]. Shape (3,).
    """
    into = sum(m * p for m, p in zip(moved, _press(state), strict=True))
    return bool(state.alarm) and into > GLANCING * math.hypot(*moved)


def _press(state: NavigationState) -> tuple[float, float, float]:
    return state.press_x, state.press_y, state.press_z
