"""Steps along random canals under random sticks, buttons, alarms and rates, and what must hold after each."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from benchmarks.canal_quality import WAYS, Hardness, hard_demonstrations
from benchmarks.fuzz.options import random_options
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from canal.navigation import NavigationOptions, NavigationState, disks_per_second, initial_state, step
from canal.navigation.joystick import JOYSTICK_SIZE, clean_joystick
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface

STEPS = 400
TINY = 1e-9
RATES = (17.0, 20.0, 33.3, 40.0, 50.0, 60.0, 100.0, 250.0)
"""[Hz]"""
COUNTERS = ("corrections", "backtracks", "correction_time_s", "correction_distance_m")
PATIENCE_S = 4.0
"""[s] After a press something has moved by then: the longest pause of the gripper is shorter."""


@cache
def canal_of(kind: int) -> CanalSurface:
    """Canals of all shapes: pinched, wide at home, elliptic, over a table, of radius zero."""
    way = WAYS[kind % len(WAYS)]
    rng = np.random.default_rng(kind)
    variant = kind // len(WAYS) % 5
    hardness = Hardness(spread=0.05, pinch=0.25) if variant == 1 else Hardness()
    demonstrations = hard_demonstrations(kind, 3, way, hardness)
    options = LearningOptions(ellipse=variant == 2, margin=0.02 if variant == 4 else 0.0)
    if variant == 3:
        lowest = float(learn_canal(demonstrations).directrix[:, 2].min())
        options = LearningOptions(support_planes=(SupportPlane((0.0, 0.0, 1.0), lowest - 0.01 * rng.random()),))
    if variant == 4:
        demonstrations = [demonstrations[0]] * 2
        options = LearningOptions()
    return learn_canal(demonstrations, options)


class Hand:
    """A hand that presses and pushes at random, each for a while."""

    def __init__(self, rng: np.random.Generator, dt: float) -> None:
        self._rng, self._dt = rng, dt
        self._stick, self._buttons = np.zeros(2), np.zeros(4)
        self._force = np.zeros(3)
        self._alarm = 0.0
        self.moving = False

    def _now(self, per_second: float) -> bool:
        return bool(self._rng.random() < per_second * self._dt)

    def joystick(self) -> np.ndarray:
        """What it does in this step, shape (6,)."""
        rng = self._rng
        if self._now(2.0):
            self._stick = rng.uniform(-1, 1, 2) if rng.random() < 0.5 else np.zeros(2)
            if rng.random() < 0.05:
                self._stick[rng.integers(2)] = rng.choice([np.nan, np.inf, 7.0, 1e-12])
        for k, often in enumerate((1.0, 0.7, 0.7, 0.2)):
            if self._now(often if not self._buttons[k] else 6.0):
                self._buttons[k] = 1.0 - self._buttons[k]
        if self._now(1.0):
            self.moving = not self.moving
        return clean_joystick(np.concatenate([self._stick, self._buttons]))

    def contact(self) -> dict[str, Any]:
        """Force and alarm of this step, as `step` takes them."""
        rng = self._rng
        if self._now(0.3 if not self._alarm else 1.0):
            self._alarm = 0.0 if self._alarm else float(rng.uniform(151, 600))
            # From the net force of one contact to that of a wedged hand, none.
            self._force = rng.normal(size=3)
            self._force *= self._alarm * rng.choice([1.0, 0.6, 0.2, 0.0]) / np.linalg.norm(self._force)
            if rng.random() < 0.02:
                self._force[rng.integers(3)] = np.nan
        return {"alarm": self._alarm, "force": self._force.tolist()}


def case(seed: int) -> str:
    """Some seconds of travel under a random hand; then something must still move it."""
    rng = np.random.default_rng(seed)
    canal = canal_of(int(rng.integers(25)))
    options = random_options(NavigationOptions(), rng, share=0.3)
    options = replace(options, gripper_pause_s=min(1.0, options.gripper_pause_s))
    options = replace(options, gripper_pause_limit_s=min(2.0, options.gripper_pause_limit_s))
    dt = 1.0 / float(rng.choice(RATES))
    hand, state = Hand(rng, dt), initial_state(canal)
    if rng.random() < 0.5:
        state = _somewhere(canal, state, rng)
    for k in range(STEPS):
        joystick, contacts = hand.joystick(), hand.contact()
        after = step(canal, state, joystick, dt, gripper_moving=hand.moving, options=options, **contacts)
        try:
            check(canal, state, after, joystick, dt, options)
        except AssertionError as error:
            raise AssertionError(f"step {k}, dt {dt}, {joystick}, {contacts}, {options}\n{state}\n{after}") from error
        state = after
    assert_not_stuck(canal, state, dt, options, {})
    assert_not_stuck(canal, state, dt, options, hand.contact())
    return f"{len(canal.demonstrations)} demonstrations, {'ellipses' if canal.ellipses is not None else 'circles'}"


def _somewhere(canal: CanalSurface, state: NavigationState, rng: np.random.Generator) -> NavigationState:
    """Running, on the way, off the directrix."""
    disk, eta = float(rng.uniform(0, canal.n_disks - 1)), float(rng.uniform(0, 1))
    home = canal.home_disk
    legs = (0, 1) if disk < home else (2, 3)
    return replace(
        state,
        disk=disk,
        eta=eta,
        phi=float(rng.uniform(-math.pi, math.pi)),
        leg=float(rng.choice(legs)),
        anchor_disk=disk,
        anchor_eta=eta,
        running=1.0,
    )


def check(
    canal: CanalSurface,
    before: NavigationState,
    after: NavigationState,
    joystick: np.ndarray,
    dt: float,
    options: NavigationOptions,
) -> None:
    """What holds for every step."""
    assert np.isfinite(after.to_vector()).all(), "not finite"
    assert 0.0 <= after.disk <= canal.n_disks - 1, "off the canal"
    assert 0.0 <= after.eta <= 1.0, "off the disk"
    for name in COUNTERS:
        assert getattr(after, name) >= getattr(before, name), f"{name} falls"
    p, q = (canal.point(s.disk, s.eta, s.phi) for s in (before, after))
    if not after.running:
        assert np.array_equal(p, q), "moves while stopped"
        return
    stick = math.hypot(*joystick[:2])
    if after.correcting:
        assert after.disk == before.disk, "travels while corrected"
        assert np.linalg.norm(q - p) <= 20.0 / options.delta * dt * stick * (1 + 1e-6) + TINY, "corrects too fast"
        return
    disks = disks_per_second(canal, options) * dt
    if disks > canal.n_disks / 8:
        return  # a step of a good part of the canal: what it may do on the way is not seen from its ends
    assert abs(after.disk - before.disk) <= disks * (1 + 1e-9) + TINY, "travels too fast"
    taken = abs(after.eta - before.eta) * max(canal.radius(after.disk), canal.radius(before.disk))
    speed = canal.length / (canal.n_disks - 1) * disks
    assert taken <= 1.2 * speed + TINY, (
        f"the strategy takes away {1e3 * taken:.2f} mm in {1e3 * speed:.2f} mm of travel"
    )
    assert after.phi == before.phi, "turns on its disk"


def assert_not_stuck(
    canal: CanalSurface, state: NavigationState, dt: float, options: NavigationOptions, contacts: dict[str, Any]
) -> None:
    """With everything let go, and whatever presses, some button or push of the stick gets the robot going again."""
    rest = np.zeros(JOYSTICK_SIZE)
    for k in range(math.ceil(PATIENCE_S / dt)):
        state = step(canal, state, rest, dt, options=options, **contacts)
        if k * dt > 0.2 and state.pause_s < 0:
            break
    tries: dict[str, list[np.ndarray]] = {"nothing": []}
    for name, index in (("gripper", 2), ("reverse", 3), ("start", 4)):
        tries[name] = [np.eye(JOYSTICK_SIZE)[index]]
    tries["start, reverse"] = [*tries["start"], rest, *tries["reverse"]]
    for angle in np.arange(8) * math.pi / 4:
        push = np.concatenate([[math.cos(angle), math.sin(angle)], np.zeros(4)])
        tries[f"start, stick {angle:.1f}"] = [*tries["start"], rest, *[push] * math.ceil(0.2 / dt)]
    moved = False
    for presses in tries.values():
        now, begin = state, canal.point(state.disk, state.eta, state.phi)
        for joystick in [*presses, *[rest] * math.ceil(PATIENCE_S / dt)]:
            now = step(canal, now, joystick, dt, options=options, **contacts)
            if np.linalg.norm(canal.point(now.disk, now.eta, now.phi) - begin) > 1e-6 or now.disk != state.disk:
                moved = True
                break
        if moved:
            break
    assert moved, f"stuck: {state} with {options}, {contacts}"
