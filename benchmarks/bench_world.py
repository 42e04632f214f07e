"""Whole runs of many seeds, looked at every 10 ms: `make bench-world ARGS="--scenario laundry --seeds 20"`.

What a summary samples at the control rate is here looked at 100 times a second: how deep anything lies in the
surroundings, how far what is held slips along the pads, and how fast the run is, in processor time (looking itself is
not counted), half second by half second. Each run is a process of its own.
"""

import argparse
import math
import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from pydrake.systems.framework import Context

from benchmarks.table import Row, print_table, write_csv
from diagrams.deformable.items import deformable_positions
from diagrams.geometry.contacts import collision_shapes, each_contact
from diagrams.scenario import load_scenario, with_items
from diagrams.scene.scene import RigidItem
from diagrams.shared_autonomy import SharedAutonomy, build_shared_autonomy
from diagrams.station.sleeping_item import make_sleeping_item
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.results.summary import RunResult, summarize
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate
from models import TCP_FRAME

TICK_S = 0.01
HALF_S = 0.5
LIFTED_M = 0.10
"""Rise after which an item hangs in the hand as it will be carried."""
NEAREST = 5
"""Nodes of cloth, those next to the TCP, whose mean tells the slip."""


class Watch:
    """Looks at a run after each step; what it saw is in its attributes."""

    def __init__(self, system: SharedAutonomy) -> None:
        self._system = system
        self._next_tick = self._next_half = 0.0
        self._spent, self._since = 0.0, time.process_time()
        plant, scene = system.station.plant, system.station.scene
        self._hand = set(collision_shapes(plant, [scene.lio]))
        self._sleepers = [make_sleeping_item(plant, system.station.scene_graph, item) for item in scene.items]
        self._set_down = False
        self._at_grip: tuple[float, list[float]] | None = None
        self._held: tuple[int, np.ndarray, np.ndarray] | None = None
        self.penetration: list[float] = []
        """[m], at every tick."""
        self.slip: dict[str, float] = {}
        """Greatest of each item in a carry, until it is set down [m]."""
        self.factors: list[float] = []
        """Simulated over processor time, of each half second."""

    def __call__(self, root: Context) -> None:
        begin = time.process_time()
        if root.get_time() >= self._next_half - 1e-9:
            if root.get_time() > 0:
                self.factors.append(HALF_S / (begin - self._since - self._spent))
            self._since, self._spent = begin, 0.0
            self._next_half += HALF_S
        if root.get_time() >= self._next_tick - 1e-9:
            self._next_tick += TICK_S
            self._look(root)
        self._spent += time.process_time() - begin

    def _look(self, root: Context) -> None:
        station = self._system.station
        context = station.GetMyContextFromRoot(root)
        self.penetration.append(float(station.GetOutputPort("penetration").Eval(context)[0]))
        closed = self._system.navigator.state(self._system.navigator.GetMyContextFromRoot(root)).gripper_closed
        plant = station.plant
        plant_context = plant.GetMyContextFromRoot(root)
        X_WT = plant.EvalBodyPoseInWorld(plant_context, plant.GetBodyByName(TCP_FRAME, station.scene.lio))
        if not closed:
            self._at_grip = self._held = None
            self._set_down = False
            return
        height = float(X_WT.translation()[2])
        clouds = [self._points(plant_context, k, X_WT) for k in range(len(station.scene.items))]
        heights = [float(X_WT.multiply(points.mean(axis=0))[2]) for points in clouds]
        if self._at_grip is None:
            self._at_grip = height, heights
        if self._held is None and height - self._at_grip[0] > LIFTED_M:
            risen = np.subtract(heights, self._at_grip[1])
            k = int(np.argmax(risen))
            if risen[k] > LIFTED_M / 2:
                points = clouds[k]
                near = np.argsort(np.linalg.norm(points, axis=1))[:NEAREST]
                self._held = k, points[near].mean(axis=0), near
        if self._held is None:
            return
        k, before, near = self._held
        self._set_down |= self._borne(plant_context, k) > self._sleepers[k].weight / 2
        if not self._set_down:
            moved = clouds[k][near].mean(axis=0) - before
            slip = float(np.hypot(moved[0], moved[2]))  # along the pads; y is how they squeeze
            name = station.scene.items[k].name
            self.slip[name] = max(slip, self.slip.get(name, 0.0))

    def _borne(self, plant_context: Context, k: int) -> float:
        """How much of item k lies on anything but the robot [N]."""
        results = self._system.station.plant.get_contact_results_output_port().Eval(plant_context)
        upwards, own = 0.0, self._sleepers[k].own
        for a, b, force in each_contact(results):
            if a in own and b not in self._hand:
                upwards += force[2]
            elif b in own and a not in self._hand:
                upwards -= force[2]
        return upwards

    def _points(self, plant_context: Context, k: int, X_WT: Any) -> np.ndarray:
        """Of item k in the tool's frame [m]: its nodes, or the origin of a rigid one. Shape (n, 3)."""
        plant, item = self._system.station.plant, self._system.station.scene.items[k]
        if isinstance(item, RigidItem):
            points = plant.EvalBodyPoseInWorld(plant_context, item.body).translation()[None]
        else:
            points = deformable_positions(plant, plant_context, item)
        return X_WT.inverse().multiply(points.T).T


class WatchedRun(NamedTuple):
    """A whole run, and what was seen of it."""

    system: SharedAutonomy
    result: RunResult
    summary: dict[str, Any]
    watch: Watch


def watched_run(
    name: str,
    kind: str | None,
    seed: int,
    *,
    orientation: bool = True,
    also: Callable[[SharedAutonomy, Context], None] = lambda system, root: None,
) -> WatchedRun:
    """One run of a scenario, watched; `also` is called after each step of the plant.

    Without `orientation` its weight is zero, and no contact stops the robot.
    """
    scenario = load_scenario(name)
    if kind is not None:
        scenario = with_items(scenario, kind)
    canal = prepare_canal(scenario, RunOptions(headless=True))
    if not orientation:
        canal = replace(canal, orientation_weights=np.zeros(canal.n_disks))
        scenario.monitor.force_limit_n = math.inf
    system = build_shared_autonomy(scenario=scenario, canal=canal, seed=seed)
    watch = Watch(system)

    def look(root: Context) -> None:
        watch(root)
        also(system, root)

    names = [item.name for item in scenario.items]
    result = simulate(system, task=scenario.task, seed=seed, item_names=names, duration=900.0, watch=look)
    return WatchedRun(system, result, summarize(result), watch)


def measure(name: str, kind: str | None, seed: int, orientation: bool = True) -> dict[str, tuple[float, str]]:
    """One run: metrics with their units."""
    _, _, summary, watch = watched_run(name, kind, seed, orientation=orientation)
    factors, depth = np.array(watch.factors), np.array(watch.penetration)
    force = {pair: (value, "N") for pair, value in summary["max_contact_force_n"].items()}
    return {
        "success": (float(summary["success"]), "1"),
        "task time": (summary["task_time_s"], "s"),
        "correction share": (100 * summary["correction_share"], "%"),
        "backtracks": (float(summary["backtracks"]), "1"),
        "real-time factor": (len(factors) / (1 / factors).sum(), "1"),
        "worst half second": (float(factors.min()), "1"),
        "penetration": (1e3 * float(depth.max()), "mm"),
        "ticks deeper than 5 mm": (float((depth > 5e-3).sum()), "1"),
        "slip in a carry": (1e3 * max(watch.slip.values(), default=0.0), "mm"),
        "tool error": (1e3 * (summary["tcp_error_m"]["max"] or 0.0), "mm"),
        **force,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenario", nargs="+", default=["laundry"])
    parser.add_argument("--items", choices=("soft", "rigid"))
    parser.add_argument("--seeds", type=int, default=20, help="how many, from --first on")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--without-orientation", action="store_true", help="as the paper's ablation")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    parser.add_argument("--output", type=Path, default=Path("build/bench-world.csv"))
    arguments = parser.parse_args()
    rows: list[Row] = []
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(arguments.jobs, mp_context=spawn, max_tasks_per_child=1) as pool:
        runs = {
            (name, seed): pool.submit(measure, name, arguments.items, seed, not arguments.without_orientation)
            for name in arguments.scenario
            for seed in range(arguments.first, arguments.first + arguments.seeds)
        }
        for (name, seed), run in runs.items():
            figures = run.result()
            rows += [Row(name, f"seed {seed}", metric, *figure) for metric, figure in figures.items()]
            print(name, seed, *(f"{m}={v:.3g}" for m, (v, _) in figures.items()), flush=True)
    for name in arguments.scenario:
        for metric in dict.fromkeys(row.metric for row in rows if row.case == name):
            of = [row for row in rows if row.case == name and row.metric == metric]
            values = np.array([row.value for row in of])
            for word, value in (("least", values.min()), ("mean", values.mean()), ("greatest", values.max())):
                rows.append(Row(name, word, metric, float(value), of[0].unit))
    print_table(row for row in rows if not row.contender.startswith("seed"))
    write_csv(arguments.output, rows)


if __name__ == "__main__":
    main()
