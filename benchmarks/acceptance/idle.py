"""Idling: never started, waiting at pick, stopped in mid-leg, blocked by a wall. It stands, fast, in flat memory."""

from __future__ import annotations

import resource
import time
from pathlib import Path

import numpy as np
from pydrake.systems.framework import Context

from benchmarks.acceptance.check import Check, Count, Figures, Job, Worst, at_least, at_most, exactly
from benchmarks.acceptance.commands import empty_folder
from benchmarks.canal_quality import RECORDED
from canal.navigation.joystick import JOYSTICK_SIZE, START, STOP
from diagrams.scenario import load_scenario
from diagrams.shared_autonomy import build_shared_autonomy
from diagrams.station.lio_drive import ARM
from diagrams.teleop.joystick_recording import JoystickRecording
from geosacs_drake.prepare_canal import prepare_canal, prepare_task
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate
from models import SCENARIOS

SETTLED = 40.0
"""[s] From here on nothing happens any more: the slowest shipped canal is at pick by then."""
PRESSES: dict[str, list[tuple[float, int]]] = {
    "never started": [],
    "at pick": [(0.5, START)],
    "stopped": [(0.5, START), (4.0, STOP)],
    "blocked": [(0.5, START)],
}
"""When which button is pressed."""
WALL = """<sdf version="1.9"><model name="wall"><link name="wall"><collision name="c">
<geometry><box><size>0.3 0.3 0.05</size></box></geometry></collision></link></model></sdf>"""


def idle(scenario: str, state: str, seconds: float) -> Figures:
    """Simulate a scenario in which nobody does more than bring it into `state`."""
    with empty_folder() as folder:
        system, items = _build(scenario, state, folder)
    memory: list[int] = []
    clock: list[tuple[float, float]] = []

    def watch(root: Context) -> None:
        if root.get_time() >= SETTLED and (not clock or root.get_time() >= clock[-1][0] + 10.0):
            clock.append((root.get_time(), time.process_time()))
            memory.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)

    result = simulate(system, task="idle", seed=0, item_names=items, duration=seconds, watch=watch)
    signals = result.signals
    late = signals["time"] >= SETTLED
    print(result.reason, signals["time"][-1], memory, dict(zip(result.contact_pairs, result.peak_forces, strict=True)))
    ran = signals["time"][-1] > seconds - 1.0
    figures = {"stands": float(ran), "blocked": float(np.max(result.peak_forces, initial=0.0) > 0)}
    if ran:
        # The pose twitches while a hand presses against a wall; q tells whether the arm creeps.
        q = signals["lio_state"][late, :ARM]
        figures |= {
            "creep": float(np.abs(q[-50:].mean(axis=0) - q[:50].mean(axis=0)).max()),
            "real time": (clock[-1][0] - clock[0][0]) / (clock[-1][1] - clock[0][1]),
            "memory": (memory[-1] - memory[0]) / 1024,
            "not finite": sum(int((~np.isfinite(s)).sum()) for n, s in signals.items() if n != "ik_status"),
        }
    return figures


def _build(scenario: str, state: str, folder: Path):
    """The system of a run with a recorded thumb, and its items' names."""
    demos: tuple[Path, ...] = ()
    name: str | Path = scenario
    if scenario == "recorded":
        name, demos = "relocation", tuple(sorted(RECORDED.glob("*.npz")))
    if state == "blocked":
        name = _with_wall(str(name), folder)
    options = RunOptions(headless=True, demos=demos)
    spec = load_scenario(name)
    spec, canal = prepare_task(spec, options)
    recording = _recording(PRESSES[state])
    system = build_shared_autonomy(scenario=spec, canal=canal, operator=recording, seed=0)
    return system, [item.name for item in spec.items]


def _with_wall(name: str, folder: Path) -> Path:
    """The scenario with a wall across the canal, half-way from home to pick."""
    spec = load_scenario(name)
    canal = prepare_canal(spec, RunOptions(headless=True))
    x, y, z = canal.directrix[canal.home_disk // 2] - [0.0, 0.0, 0.05]
    (folder / "wall.sdf").write_text(WALL)
    fixture = f"fixtures:\n  - {{name: wall, model: wall.sdf, position: [{x:.3f}, {y:.3f}, {z:.3f}]}}\n"
    text = (SCENARIOS / f"{name}.yaml").read_text()
    (folder / "walled.yaml").write_text(text.replace("fixtures:\n", fixture, 1) + "monitor: {force_limit_n: 30}\n")
    return folder / "walled.yaml"


def _recording(presses: list[tuple[float, int]]) -> JoystickRecording:
    """Short presses, and nothing after."""
    rows = [(0.0, np.zeros(JOYSTICK_SIZE))]
    for when, button in presses:
        rows += [(when, np.eye(JOYSTICK_SIZE)[button]), (when + 0.1, np.zeros(JOYSTICK_SIZE))]
    return JoystickRecording(np.array([t for t, _ in rows]), np.array([level for _, level in rows]), "idle")


def checks() -> list[Check]:
    """All scenarios for minutes, some for ten."""
    lines = (
        Count("stand to the end", "stands"),
        Worst("creep of a joint", "creep", at_most(1e-3, "rad")),
        Worst("times real time, of processor time", "real time", at_least(15)),
        Worst("memory grows by", "memory", at_most(60, "MB")),
        Worst("samples that are not finite", "not finite", exactly(0)),
    )
    long = [("relocation", "never started"), ("laundry", "at pick")]
    short = [
        *((s, "never started") for s in ("laundry", "relocation-far", "laundry-turned", "laundry-moved")),
        *((s, "at pick") for s in ("relocation", "laundry-turned", "laundry-crowded", "laundry-hanging")),
        *((s, "stopped") for s in ("relocation", "laundry", "laundry-narrow", "laundry-straight")),
    ]
    absent = "" if len(list(RECORDED.glob("*.npz"))) == 2 else f"no recordings in {RECORDED}"
    recorded = [Job(idle, ("recorded", "never started", 600.0), 0.8), Job(idle, ("recorded", "stopped", 200.0), 0.4)]
    return [
        Check("idle for 600 s", "12.1", [Job(idle, (*one, 600.0), 0.8) for one in long], lines),
        Check("idle for 200 s", "12.1", [Job(idle, (*one, 200.0), 0.4) for one in short], lines),
        Check("idle, recorded canal", "12.1", recorded, lines, missing=absent),
        Check(
            "idle, blocked by a wall",
            "12.1, 12.3",
            [Job(idle, ("relocation", "blocked", 200.0), 0.5)],
            (Count("were blocked", "blocked"), *lines[:2], *lines[3:]),
        ),
    ]
