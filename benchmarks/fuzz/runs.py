"""Whole runs in the simulation: random sticks and buttons in random scenarios, looked at at every step."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from pydrake.systems.framework import Context

from benchmarks.fuzz.options import random_options
from canal.errors import InputError
from canal.navigation import FIELD_NAMES
from canal.navigation.joystick import GRIPPER, JOYSTICK_PERIOD, JOYSTICK_SIZE, REVERSE, START, STOP
from canal.surface import CanalSurface
from diagrams.scenario import Retarget, Scenario, load_scenario, with_items
from diagrams.scene.world import Item
from diagrams.shared_autonomy import SharedAutonomy, build_shared_autonomy
from diagrams.teleop.joystick_recording import JoystickRecording
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.results.summary import RunResult, summarize
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate

RIGID = (
    ("relocation",) * 4 + ("laundry",) * 3 + ("laundry-narrow", "laundry-crowded", "laundry-turned", "laundry-moved")
)
SOFT_SHARE = 0.05
LIMITS = np.radians([170.0, 110.0, 115.0, 170.0, 115.0, 170.0])
"""[rad] of the joints (docs/method.md, 6)."""
SPEED = math.radians(95.0)
"""[rad/s] of each joint (docs/method.md, 6)."""
GIVES = 0.02
"""[rad] by which a contact may press a drive beyond what it was told."""
SHORTEST, LONGEST = 8.0, 25.0
"""[s] simulated."""


class _Watch:
    """What is seen of the arm and the items at each step of the plant."""

    def __init__(self, system: SharedAutonomy) -> None:
        station = system.station
        self._station, self._plant = station, station.plant
        self.speed = self.beyond = 0.0
        self.lowest = math.inf
        self.finite = True

    def __call__(self, root: Context) -> None:
        context, lio = self._station.plant_context(root), self._station.scene.lio
        q, v = self._plant.GetPositions(context, lio)[:6], self._plant.GetVelocities(context, lio)[:6]
        self.finite &= bool(np.isfinite(q).all() and np.isfinite(v).all())
        self.speed = max(self.speed, float(np.abs(v).max()))
        self.beyond = max(self.beyond, float((np.abs(q) - LIMITS).max()))
        for item in self._station.scene.rigid_items:
            self.lowest = min(self.lowest, float(self._plant.EvalBodyPoseInWorld(context, item.body).translation()[2]))


def case(seed: int) -> str:
    """One run of some seconds."""
    rng = np.random.default_rng(seed)
    scenario = _scenario(rng)
    try:
        canal = prepare_canal(scenario, RunOptions(headless=True))
        duration = float(rng.uniform(SHORTEST, LONGEST))
        operator = "simulated" if rng.random() < 0.15 else _recording(rng, duration)
        system = build_shared_autonomy(scenario=scenario, canal=canal, operator=operator, seed=int(rng.integers(1000)))
    except InputError as error:
        raise InputError(f"{scenario.task}: {error}") from None
    watch = _Watch(system)
    names = [item.name for item in scenario.items]
    result = simulate(system, task=scenario.task, seed=seed, item_names=names, duration=duration, watch=watch)
    said = f"{scenario}\n{result.reason}"
    try:
        _check(result, watch, canal, scenario, duration)
    except AssertionError as error:
        raise AssertionError(f"{error}\n{said}") from error
    pressed = bool(np.max(result.peak_forces, initial=0.0) > scenario.monitor.force_limit_n)
    return f"{scenario.task}, {scenario.items[0].kind}" + (", pressed hard" if pressed else "")


def _scenario(rng: np.random.Generator) -> Scenario:
    """A shipped scenario with other options, items elsewhere, and a canal bent to other ends."""
    scenario = load_scenario(RIGID[rng.integers(len(RIGID))])
    scenario = with_items(scenario, "soft" if rng.random() < SOFT_SHARE else "rigid")
    scenario.navigation = random_options(scenario.navigation, rng, share=0.3)
    scenario.navigation = dataclasses.replace(
        scenario.navigation, speed_scale=min(scenario.navigation.speed_scale, float(rng.choice([1.5, 4.0])))
    )
    scenario.operator = random_options(scenario.operator, rng, share=0.2, wild=0.02)
    scenario.monitor = random_options(scenario.monitor, rng, share=0.3)
    if rng.random() < 0.5:
        scenario.ik = random_options(scenario.ik, rng, share=0.3, wild=0.02)
    if rng.random() < 0.4:
        scenario.control_rate_hz = float(rng.choice([17.0, 20.0, 33.0, 40.0, 60.0, 100.0]))
    if rng.random() < 0.3:
        scenario.contact = dataclasses.replace(
            scenario.contact,
            time_step=float(rng.choice([0.002, 0.005, 0.008, 0.01])),
            approximation=str(rng.choice(["lagged", "similar", "sap"])),
        )
    if rng.random() < 0.1:
        scenario.robot = dataclasses.replace(
            scenario.robot, yaw_deg=scenario.robot.yaw_deg + float(rng.normal(scale=3.0))
        )
    if rng.random() < 0.3:
        yaws = rng.normal(scale=10.0, size=2)
        scenario.retarget = Retarget(pick_yaw_deg=float(yaws[0]), place_yaw_deg=float(yaws[1]))
    scenario.items = [_moved(item, rng) for item in scenario.items]
    return scenario


def _moved(item: Item, rng: np.random.Generator) -> Item:
    """An item that starts up to some centimetres elsewhere, turned otherwise."""
    if rng.random() < 0.7:
        return item
    x, y, z = item.start.center
    center = [x + float(rng.normal(scale=0.006)), y + float(rng.normal(scale=0.006)), z]
    start = dataclasses.replace(item.start, center=center, yaw_deg=[-20.0, 20.0])
    return dataclasses.replace(item, start=start)


def _recording(rng: np.random.Generator, duration: float) -> JoystickRecording:
    """A hand that soon presses Start, then pushes and presses at random."""
    ticks = math.ceil(duration / JOYSTICK_PERIOD) + 2
    joystick = np.zeros((ticks, JOYSTICK_SIZE))
    joystick[int(rng.integers(0, 10)), START] = 1.0
    stick = np.zeros(2)
    for k in range(10, ticks):
        if rng.random() < 0.08:
            stick = rng.uniform(-0.7, 0.7, 2) if rng.random() < 0.4 else np.zeros(2)
        joystick[k, :2] = stick
        for button, often in ((GRIPPER, 0.01), (REVERSE, 0.012), (START, 0.02), (STOP, 0.002)):
            held = joystick[k - 1, button]
            joystick[k, button] = float(rng.random() < (0.6 if held else often))
    return JoystickRecording(JOYSTICK_PERIOD * np.arange(ticks), joystick, "random hand")


def _check(result: RunResult, watch: _Watch, canal: CanalSurface, scenario: Scenario, duration: float) -> None:
    """What holds for every run."""
    signals = result.signals
    assert "failed" not in result.reason, result.reason
    done = result.placed_times.size > 0 and (result.placed_times >= 0).all()
    gave_up = "operator stopped" in result.reason
    assert done or gave_up or signals["time"][-1] > duration - 0.1, (
        f"ended at {signals['time'][-1]:.2f} s of {duration:.2f}"
    )
    assert watch.finite, "joints that are not finite"
    for name, values in signals.items():
        assert name == "ik_status" or np.isfinite(values).all(), f"{name} is not finite"
    assert watch.beyond <= GIVES, f"a joint {watch.beyond:.3f} rad beyond its limit"
    command = signals["desired_state"][:, :6]
    assert (np.abs(command) <= LIMITS + 1e-9).all(), "commanded beyond a limit"
    period = 1.0 / scenario.control_rate_hz
    speeds = np.abs(np.diff(command, axis=0)).max(initial=0.0) / period
    assert speeds <= SPEED * (1 + 1e-6), f"commanded {math.degrees(speeds):.1f}°/s"
    assert watch.speed <= SPEED * 1.02, f"a joint moved at {math.degrees(watch.speed):.1f}°/s"
    assert watch.lowest > -0.02, f"an item fell through the floor, to {watch.lowest:.2f} m"
    _check_navigation(signals["navigation_state"], canal)
    summary = summarize(result)
    assert summary["ik"]["bound_violations"] == 0, f"{summary['ik']['bound_violations']} bound violations"


def _check_navigation(states: np.ndarray, canal: CanalSurface) -> None:
    state = {name: states[:, k] for k, name in enumerate(FIELD_NAMES)}
    assert ((state["eta"] >= 0) & (state["eta"] <= 1)).all(), "off the disk"
    assert ((state["disk"] >= 0) & (state["disk"] <= canal.n_disks - 1)).all(), "off the canal"
    for name in ("corrections", "backtracks", "correction_time_s", "correction_distance_m"):
        assert (np.diff(state[name]) >= 0).all(), f"{name} falls"
    halts = ("waiting", "correcting", "blocked", "paused", "alarm")
    going = (state["running"] > 0) & (state["pause_s"] < 0)
    for name in halts:
        if name in state:
            going &= state[name] == 0
    # Of two ticks on which nothing holds it, the second is further on than the first.
    both = going[1:] & going[:-1] & (state["leg"][1:] == state["leg"][:-1])
    stands = both & (np.diff(state["disk"]) == 0)
    assert not stands.any(), (
        f"stands at {int(stands.sum())} ticks though nothing holds it, first {int(np.argmax(stands))}"
    )
