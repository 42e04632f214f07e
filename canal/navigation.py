"""Travel along a canal: where we are, what a thumb does to it, and what comes next (paper IV-C to IV-E, V-D, V-E).

The state is the disk, the point (η, φ) on it and the leg of the cycle *home, pick, home, place, home*. A step moves
along the canal, or, while the stick is off centre, on the disk alone. No clock and no robot: time comes in as `dt`.
"""

import math
from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from canal.navigation_state import FIELD_NAMES, Leg, NavigationState
from canal.options import NotNegative, Positive, Share, options
from canal.surface import CanalSurface

__all__ = [
    "FIELD_NAMES",
    "MIN_RADIUS",
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

MIN_RADIUS = 1e-9
"""[m] Below this a disk is a point: there is nothing to correct, and the ratio is carried through it."""
_HELD = ("held_gripper", "held_reverse", "held_start", "held_stop", "held_alarm")


@options("navigation")
class NavigationOptions:
    """How a canal is travelled. Times in seconds, speeds relative to the demonstrations'."""

    speed_scale: Annotated[float, Field(gt=0, le=100)] = 1.0
    """1: a whole pass takes the mean moving time of the demonstrations; 2: half of it."""
    delta: Annotated[float, Field(ge=1)] = 150.0
    """Sensitivity of the stick, δ of paper Table I: full stick moves 20/δ m/s."""
    dead_zone: Share = 0.1
    """A stick shorter than this is taken as centred."""
    eta_f: Share = 0.0
    """Final ratio η_f of the homeward legs: 0 converges to the directrix, 1 diverges to the wall."""
    decay: Literal["leg", "paper"] = "leg"
    """`leg`: η = η_f + (η_0 - η_f) exp(-a u²), u the part of the leg travelled. `paper`: exp(-λ·disks), Eq. in IV-C."""
    decay_a: Positive = 11.7
    """a of the default decay: what the robot's code comes to over 216 disks."""
    decay_lambda: NotNegative = 5e-4
    """λ of paper Table I, per disk; for `decay: paper`."""
    wait_at_ends: bool = True
    """At pick and place, wait for the operator: a grip, a release or a reversal goes on."""
    end_zone: Share = 0.1
    """Last part of an outward leg in which a grasp (a release) counts as made at pick (at place) and sends home."""
    gripper_pause_s: NotNegative = 0.25
    """Shortest pause after the gripper button; it lasts while the fingers move."""
    gripper_pause_limit_s: Positive = 2.0
    """Longest pause: fingers that never come to rest do not hold the arm up."""


def initial_state(canal: CanalSurface) -> NavigationState:
    """At home, on the directrix, about to go to pick, not yet started."""
    return NavigationState(disk=float(canal.home_disk), anchor_disk=float(canal.home_disk))


def phase(canal: CanalSurface, disk: float) -> float:
    """The paper's d in [-1, 1]: -1 pick, 0 home, +1 place (V-E)."""
    home = canal.home_disk
    return (disk - home) / (home if disk < home else canal.n_disks - 1 - home)


def leg_end(canal: CanalSurface, leg: Leg) -> float:
    """Disk at which a leg ends."""
    if leg.homeward:
        return float(canal.home_disk)
    return 0.0 if leg is Leg.HOME_TO_PICK else float(canal.n_disks - 1)


def strategy_ratio(canal: CanalSurface, state: NavigationState, disk: float, options: NavigationOptions) -> float:
    """Ratio η that the leg's strategy gives at `disk`: fixed outwards, decaying towards home (paper IV-C)."""
    leg = Leg(int(state.leg))
    if not leg.homeward:
        return state.anchor_eta
    travelled = abs(disk - state.anchor_disk)
    if options.decay == "paper":
        decay = math.exp(-options.decay_lambda * travelled)
    else:
        whole = abs(leg_end(canal, leg) - state.anchor_disk)
        u = min(travelled / whole, 1.0) if whole > 0 else 1.0
        decay = math.exp(-options.decay_a * u * u)
    return options.eta_f + (state.anchor_eta - options.eta_f) * decay


def step(
    canal: CanalSurface,
    state: NavigationState,
    joystick: np.ndarray,
    dt: float,
    *,
    gripper_moving: bool = False,
    alarm: bool = False,
    options: NavigationOptions | None = None,
) -> NavigationState:
    """One step of `dt` seconds under a joystick vector (see `canal.joystick`); a value that is not finite counts as 0.

    While the stick is off centre s stands still and the point moves on its disk by (k_x x_s + k_y y_s)·20/δ·dt,
    saturated at r(s) (paper V-D). Else the point goes along the canal by the leg's ratio strategy. A rising
    `alarm` blocks all motion and leaves the gripper as it is, until the person reverses (or starts anew).
    """
    options = options or NavigationOptions()
    k_x, k_y, *levels = (v if math.isfinite(v) else 0.0 for v in np.asarray(joystick, dtype=float).tolist())
    gripper, reverse, start, stop = (level > 0.5 for level in levels)
    if alarm and not state.held_alarm:
        state = replace(state, blocked=1.0)
    if start and not state.held_start:
        state = replace(state, running=1.0, blocked=0.0)
    if stop and not state.held_stop:
        state = replace(state, running=0.0)
    if state.running:
        if reverse and not state.held_reverse:
            state = _reverse(state)
        if gripper and not state.held_gripper:
            state = _toggle_gripper(canal, state, options)
    held = (gripper, reverse, start, stop, alarm)
    if held != (state.held_gripper, state.held_reverse, state.held_start, state.held_stop, state.held_alarm):
        state = replace(state, **dict(zip(_HELD, map(float, held), strict=True)))
    if not state.running or state.blocked:
        return _end_correction(state)
    if state.pause_s >= 0:
        elapsed = state.pause_s + dt
        done = elapsed >= options.gripper_pause_limit_s or (elapsed >= options.gripper_pause_s and not gripper_moving)
        return _end_correction(replace(state, pause_s=-1.0 if done else elapsed))
    if math.hypot(k_x, k_y) > options.dead_zone:
        return _correct(canal, state, k_x, k_y, dt, options)
    return _advance(canal, _end_correction(state), dt, options)


def _reverse(state: NavigationState) -> NavigationState:
    """Backtracking: the same disks the other way, the strategy starting anew from here."""
    return replace(
        state,
        leg=float(Leg(int(state.leg)).reversed),
        anchor_disk=state.disk,
        anchor_eta=state.eta,
        waiting=0.0,
        blocked=0.0,
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


def _end_correction(state: NavigationState) -> NavigationState:
    """When the stick is released, the strategy starts anew from the corrected point."""
    if not state.correcting:
        return state
    return replace(state, correcting=0.0, anchor_disk=state.disk, anchor_eta=state.eta)


def _correct(
    canal: CanalSurface,
    state: NavigationState,
    k_x: float,
    k_y: float,
    dt: float,
    options: NavigationOptions,
) -> NavigationState:
    """Move the point on its disk, saturated at the disk's edge (paper IV-D, V-D)."""
    norm = math.hypot(k_x, k_y)
    scale = 20.0 / options.delta * dt / max(norm, 1.0)
    p = canal.point(state.disk, state.eta, state.phi)
    x, y = canal.axes(state.disk)
    eta, phi = canal.disk_coordinates(state.disk, p + scale * (k_x * x + k_y * y))
    if canal.radius(state.disk) < MIN_RADIUS:
        eta, phi = state.eta, state.phi
    eta = min(eta, 1.0)
    moved = canal.point(state.disk, eta, phi) - p
    return replace(
        state,
        eta=eta,
        phi=phi,
        correcting=1.0,
        corrections=state.corrections + (not state.correcting),
        correction_time_s=state.correction_time_s + dt,
        correction_distance_m=state.correction_distance_m + math.sqrt(float(moved @ moved)),
    )


def disks_per_second(canal: CanalSurface, options: NavigationOptions) -> float:
    """Speed of progress: a whole pass in the mean moving time of the demonstrations, scaled."""
    return (canal.n_disks - 1) * options.speed_scale / canal.moving_time_s


def _advance(canal: CanalSurface, state: NavigationState, dt: float, options: NavigationOptions) -> NavigationState:
    """Go along the canal for `dt`; through home into the next leg, up to pick and place, turning there if told."""
    travel = disks_per_second(canal, options) * dt
    # A step may pass home and more: what is left over is travelled on the next leg, so that the control rate
    # changes nothing.
    while True:
        leg = Leg(int(state.leg))
        end = leg_end(canal, leg)
        ahead = (end - state.disk) * leg.direction
        if travel < ahead:
            disk = state.disk + leg.direction * travel
            return replace(state, disk=disk, eta=strategy_ratio(canal, state, disk, options), waiting=0.0)
        eta = strategy_ratio(canal, state, end, options)
        if not leg.homeward and options.wait_at_ends:
            return replace(state, disk=end, eta=eta, waiting=1.0)
        travel -= max(ahead, 0.0)
        state = replace(state, disk=end, eta=eta, leg=float(leg.next), anchor_disk=end, anchor_eta=eta, waiting=0.0)
