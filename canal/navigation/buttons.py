"""What a press of a button does to a travel, and which presses do nothing (paper IV-E, V-D, V-E)."""

from dataclasses import replace

from canal.navigation.options import NavigationOptions
from canal.navigation.state import Ignored, Leg, NavigationState
from canal.navigation.strategy import phase
from canal.surface import MIN_RADIUS, CanalSurface

_HELD = ("held_gripper", "held_reverse", "held_start", "held_stop", "held_stick")


def press_buttons(
    canal: CanalSurface, state: NavigationState, levels: tuple[bool, ...], stick: bool, options: NavigationOptions
) -> NavigationState:
    """What the presses of this step do: those whose level has risen.

    Args:
        canal: that is travelled.
        state: before the step.
        levels: of gripper, reverse, start and stop.
        stick: whether the stick is off centre.
        options: of the travel.
    """
    gripper, reverse, start, stop = levels
    held = (gripper, reverse, start, stop, stick)
    before = (state.held_gripper, state.held_reverse, state.held_start, state.held_stop, state.held_stick)
    if held == before:
        return state
    pressed_gripper, pressed_reverse, pressed_start, pressed_stop, pressed_stick = (
        now and not was for now, was in zip(held, before, strict=True)
    )
    state = replace(state, **dict(zip(_HELD, map(float, held), strict=True)))
    if pressed_stop and not state.running:
        state = _ignore(state, Ignored.ALREADY_STOPPED)
    if stop:
        state = replace(state, running=0.0, paused=0.0)
    if pressed_start:
        state = _start(state, stop)
    if not state.running:
        useless = pressed_gripper or pressed_reverse or pressed_stick
        return _ignore(state, Ignored.STOPPED) if useless else state
    if pressed_reverse:
        state = _reverse(state)
    if pressed_gripper:
        state = _toggle_gripper(canal, state, options)
    if pressed_stick and canal.radius(state.disk) < MIN_RADIUS:
        state = _ignore(state, Ignored.POINT)
    return state


def _start(state: NavigationState, stop: bool) -> NavigationState:
    """Start goes; pressed while travelling it holds the robot on its disk, pressed again it goes on."""
    if stop:
        return _ignore(state, Ignored.STOP_HELD)
    if not state.running:
        return replace(state, running=1.0)
    if state.paused:
        return replace(state, paused=0.0)
    if state.blocked:
        return _ignore(state, Ignored.PRESSING)
    if state.waiting:
        return _ignore(state, Ignored.WAITING)
    return replace(state, paused=1.0)


def _ignore(state: NavigationState, why: Ignored) -> NavigationState:
    return replace(state, ignored=state.ignored + 1, ignored_why=float(why))


def _reverse(state: NavigationState) -> NavigationState:
    """Backtracking: the same disks the other way, the strategy starting anew from here."""
    return replace(
        state,
        leg=float(Leg(int(state.leg)).reversed),
        anchor_disk=state.disk,
        anchor_eta=state.eta,
        waiting=0.0,
        backtracks=state.backtracks + 1,
    )


def _toggle_gripper(canal: CanalSurface, state: NavigationState, options: NavigationOptions) -> NavigationState:
    """Close or open; a grasp at pick and a release at place turn towards home."""
    closed = not state.gripper_closed
    state = replace(state, gripper_closed=float(closed), pause_s=0.0)
    leg = Leg(int(state.leg))
    d = phase(canal, state.disk)
    at_end = abs(d) >= 1 - options.end_zone
    turns = (leg is Leg.HOME_TO_PICK and closed) or (leg is Leg.HOME_TO_PLACE and not closed)
    if at_end and turns:
        state = replace(state, leg=float(leg.next), anchor_disk=state.disk, anchor_eta=state.eta, waiting=0.0)
    return state
