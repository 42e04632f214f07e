"""Travel along a canal: where we are, what a thumb does to it, and what comes next (paper IV-C to IV-E, V-D, V-E).

The state is the disk, the point (η, φ) on it and the leg of the cycle *home, pick, home, place, home*. A step moves
along the canal, or, while the stick is off centre, on the disk alone. No clock and no robot: time comes in as `dt`.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from canal.navigation.buttons import press_buttons
from canal.navigation.options import NavigationOptions
from canal.navigation.pressing import cut_stick, feel, presses, presses_along
from canal.navigation.state import FIELD_NAMES, Ignored, Leg, NavigationState
from canal.navigation.strategy import leg_end, phase, strategy_ratio
from canal.surface import MIN_RADIUS, CanalSurface

__all__ = [
    "FIELD_NAMES",
    "Ignored",
    "Leg",
    "NavigationOptions",
    "NavigationState",
    "disks_per_second",
    "initial_state",
    "leg_end",
    "phase",
    "step",
    "strategy_ratio",
]


def initial_state(canal: CanalSurface) -> NavigationState:
    """At home, on the directrix, about to go to pick, not yet started."""
    return NavigationState(disk=float(canal.home_disk), anchor_disk=float(canal.home_disk))


def step(
    canal: CanalSurface,
    state: NavigationState,
    joystick: np.ndarray,
    dt: float,
    *,
    gripper_moving: bool = False,
    alarm: float = 0.0,
    force: Sequence[float] = (0.0, 0.0, 0.0),
    options: NavigationOptions | None = None,
) -> NavigationState:
    """One step of `dt` seconds under a clean joystick vector (see `canal.navigation.joystick`).

    While the stick is off centre s stands still and the point moves on its disk by (k_x x_s + k_y y_s)·20/δ·dt,
    saturated at r(s) (paper V-D). Else the point goes along the canal by the leg's ratio strategy. While an alarm
    lasts nothing moves further in the direction that presses (see `canal.navigation.pressing`).

    Args:
        canal: that is travelled.
        state: before the step.
        joystick: as it was during the step, clean. Shape (6,).
        dt: duration of the step [s].
        gripper_moving: whether the fingers are on their way.
        alarm: force of the contact whose force is above its limit [N]; 0 for none.
        force: net contact force on the hand in the robot's base frame [N]. Shape (3,).
        options: of the travel.

    Returns:
        The state after the step.
    """
    options = options or NavigationOptions()
    k_x, k_y, *levels = np.asarray(joystick, dtype=float).tolist()
    state = feel(canal, state, (k_x, k_y), alarm, force)
    state = press_buttons(canal, state, tuple(map(bool, levels)), bool(k_x or k_y), options)
    if state.blocked:
        state = replace(state, blocked=0.0)
    if not state.running:
        return _end_correction(state)
    if state.pause_s >= 0:
        elapsed = state.pause_s + dt
        done = elapsed >= options.gripper_pause_limit_s or (elapsed >= options.gripper_pause_s and not gripper_moving)
        return _end_correction(replace(state, pause_s=-1.0 if done else elapsed))
    if k_x or k_y:
        return _correct(canal, state, (k_x, k_y), dt, options)
    if state.paused:
        return _end_correction(state)
    return _advance(canal, _end_correction(state), dt, options)


def _end_correction(state: NavigationState) -> NavigationState:
    """When the stick is released, the strategy starts anew from the corrected point."""
    if not state.correcting:
        return state
    return replace(state, correcting=0.0, anchor_disk=state.disk, anchor_eta=state.eta)


def _correct(
    canal: CanalSurface, state: NavigationState, stick: tuple[float, float], dt: float, options: NavigationOptions
) -> NavigationState:
    """Move the point on its disk, saturated at the disk's edge (paper IV-D, V-D)."""
    k_x, k_y = cut_stick(canal, state, stick)
    scale = 20.0 / options.delta * dt
    p = canal.point(state.disk, state.eta, state.phi)
    x, y = canal.axes(state.disk)
    eta, phi, moved = _on_disk(canal, state, p, scale * (k_x * x + k_y * y))
    held_back = (k_x, k_y) != stick
    if presses(state, moved.tolist()):  # along the rim, where what is left of the stick leads beyond it
        eta, phi, moved, held_back = state.eta, state.phi, 0 * moved, True
    return replace(
        state,
        eta=eta,
        phi=phi,
        correcting=1.0,
        blocked=float(held_back),
        corrections=state.corrections + (not state.correcting),
        correction_time_s=state.correction_time_s + dt,
        correction_distance_m=state.correction_distance_m + math.sqrt(float(moved @ moved)),
    )


def _on_disk(
    canal: CanalSurface, state: NavigationState, p: np.ndarray, push: np.ndarray
) -> tuple[float, float, np.ndarray]:
    """(η, φ) after a push [m] from the point `p`, and how far it moved: no further than the push."""
    if canal.radius(state.disk) < MIN_RADIUS:
        return state.eta, state.phi, np.zeros(3)
    eta, phi = canal.disk_coordinates(state.disk, p + push)
    eta = min(eta, 1.0)
    moved = canal.point(state.disk, eta, phi) - p
    wanted, got = math.sqrt(float(push @ push)), math.sqrt(float(moved @ moved))
    if got > wanted * (1 + 1e-9):
        # Cut towards the centre at a flat edge (a support plane, an ellipse), it may slide far along it.
        eta, phi = canal.disk_coordinates(state.disk, p + moved * (wanted / got))
        eta = min(eta, 1.0)
        moved = canal.point(state.disk, eta, phi) - p
    return eta, phi, moved


def disks_per_second(canal: CanalSurface, options: NavigationOptions) -> float:
    """Speed of progress: a whole pass in the mean moving time of the demonstrations, scaled.

    Args:
        canal: that is travelled.
        options: of the travel.
    """
    return (canal.n_disks - 1) * options.speed_scale / canal.moving_time_s


def _advance(canal: CanalSurface, state: NavigationState, dt: float, options: NavigationOptions) -> NavigationState:
    """Go along the canal for `dt`; through home into the next leg, up to pick and place, turning there if told."""
    travel = disks_per_second(canal, options) * dt
    if state.alarm:
        return _back_off(canal, state, travel, options)
    # A step may pass home and more: what is left over is travelled on the next leg, so that the control rate
    # changes nothing. No further than once around and what is left of whole cycles, whatever the speed.
    cycle = 2.0 * (canal.n_disks - 1)
    if travel > 2 * cycle:
        travel = cycle + math.fmod(travel, cycle)
    while True:
        leg = Leg(int(state.leg))
        end = leg_end(canal, leg)
        ahead = (end - state.disk) * leg.direction
        if ahead > 0 and travel > 0:
            state = replace(state, travelled=float(leg.direction))
        if travel < ahead:
            disk = state.disk + leg.direction * travel
            return replace(state, disk=disk, eta=strategy_ratio(canal, state, disk, options), waiting=0.0)
        eta = strategy_ratio(canal, state, end, options)
        if not leg.homeward and options.wait_at_ends:
            return replace(state, disk=end, eta=eta, waiting=1.0)
        travel -= max(ahead, 0.0)
        state = replace(state, disk=end, eta=eta, leg=float(leg.next), anchor_disk=end, anchor_eta=eta, waiting=0.0)


def _back_off(
    canal: CanalSurface, state: NavigationState, travel: float, options: NavigationOptions
) -> NavigationState:
    """Travel while an alarm lasts: only where it does not press, with the ratio as it is, and no further than a leg."""
    leg = Leg(int(state.leg))
    end = leg_end(canal, leg)
    ahead = max((end - state.disk) * leg.direction, 0.0)
    waits = not leg.homeward and options.wait_at_ends
    if ahead > 0 and presses_along(canal, state, leg.direction):
        return replace(state, blocked=1.0, waiting=0.0)
    disk = end if travel >= ahead else state.disk + leg.direction * travel
    return replace(
        state,
        disk=disk,
        leg=float(leg.next) if disk == end and not waits else state.leg,
        anchor_disk=disk,
        anchor_eta=state.eta,
        travelled=float(leg.direction) if ahead > 0 and travel > 0 else state.travelled,
        waiting=float(disk == end and waits),
    )
