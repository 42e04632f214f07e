"""Run a built diagram to its end, in half seconds, and take from it what a summary needs."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydrake.systems.analysis import Simulator, SimulatorStatus
from pydrake.systems.framework import Context, EventStatus

from diagrams.scene.scene import RigidItem
from diagrams.shared_autonomy import SharedAutonomy
from diagrams.station.sleep import sleep_manager
from geosacs_drake.failure import describe_failure
from geosacs_drake.process.command_line import one_line
from geosacs_drake.results.summary import RunResult

INTERRUPTED = "interrupted"
"""The reason of a run that was asked to end."""
CHUNK_S = 0.5
"""[s] Simulated between two looks at the clock: the summary's worst half second."""


@dataclass(frozen=True)
class Progress:
    """How far a run is, for whoever shows it."""

    time_s: float
    """Simulated so far, [s]."""
    placed: int
    """Items that are placed."""
    items: int
    """Items that there are."""


def simulate(
    system: SharedAutonomy,
    *,
    task: str,
    seed: int,
    item_names: list[str],
    duration: float,
    scenario: str = "",
    operator: str = "simulated",
    rate: float = 0.0,
    asked_to_end: Callable[[], bool] = lambda: False,
    report: Callable[[Progress], None] = lambda progress: None,
    watch: Callable[[Context], None] = lambda context: None,
    wait: Callable[[Context], None] = lambda context: None,
) -> RunResult:
    """Simulate until the task is done, given up, interrupted or out of time.

    Args:
        system: what to run.
        task: its name, for the summary.
        seed: likewise.
        item_names: likewise, in the scenario's order.
        duration: longest simulated time [s].
        scenario: its name, for the summary.
        operator: who holds the joystick, likewise.
        rate: real-time rate to aim at; 0 for as fast as possible.
        asked_to_end: looked at after each step of the plant.
        report: called after each half second.
        watch: called after each step of the plant with the diagram's context, to measure what no port tells.
        wait: called with it once everything stands at its start, and is seen; the time begins when it returns.

    Returns:
        What happened; a simulation that something inside it ends says so in `failure`, and keeps what it had.
    """
    simulator = Simulator(system.diagram)
    simulator.set_target_realtime_rate(rate)
    sleep = sleep_manager(system.station)

    def sleep_and_watch(root_context: Context) -> EventStatus:
        if sleep.is_robot_awake(root_context):
            system.peaks.look(root_context)
        status = sleep(root_context)
        watch(root_context)
        return EventStatus.ReachedTermination(system.diagram, INTERRUPTED) if asked_to_end() else status

    simulator.set_monitor(sleep_and_watch)
    root = simulator.get_context()
    monitor_context = system.monitor.GetMyContextFromRoot(root)
    factors: list[float] = []
    reason, failure = f"time is up after {duration:g} s", ""
    try:
        system.take_first_measurements(simulator.get_mutable_context())
        simulator.Initialize()
        watch(root)
        wait(root)
        simulator.ResetStatistics()  # the clock on the wall begins now
        gc.freeze()  # what is built stays: no collection looks through it again
        while root.get_time() < duration - 1e-9:
            begin, simulated = time.perf_counter(), root.get_time()
            status = simulator.AdvanceTo(min(duration, simulated + CHUNK_S))
            elapsed = time.perf_counter() - begin
            if root.get_time() - simulated > 0.99 * CHUNK_S:
                factors.append((root.get_time() - simulated) / elapsed)
            placed = system.monitor.GetOutputPort("placed_times").Eval(monitor_context)
            report(Progress(root.get_time(), int((placed >= 0).sum()), len(placed)))
            if status.reason() == SimulatorStatus.ReturnReason.kReachedTerminationCondition:
                reason = status.message()
                break
    except (Exception, SystemExit) as error:  # Drake says `SystemExit` where a condition of its own does not hold
        reason, failure = describe_failure(error, system, sleep, root), one_line(str(error)) or type(error).__name__
    finally:
        # Or all that was built for this run would stay for ever: the monitor names the diagram, which keeps it.
        simulator.clear_monitor()
        gc.unfreeze()
    return RunResult(
        task=task,
        scenario=scenario,
        operator=operator,
        items_kind=_kind(system),
        seed=seed,
        reason=reason,
        item_names=item_names,
        signals=system.log.signals(root),
        realtime_factors=np.array(factors),
        failure=failure,
        **_measured(system, root),
    )


def _kind(system: SharedAutonomy) -> str:
    kinds = {"rigid" if isinstance(item, RigidItem) else "soft" for item in system.station.scene.items}
    return kinds.pop() if len(kinds) == 1 else "mixed"


def _measured(system: SharedAutonomy, root: Context) -> dict[str, Any]:
    """What the diagram has measured by itself, as arguments of `RunResult`."""
    monitor, peaks = (s.GetMyContextFromRoot(root) for s in (system.monitor, system.peaks))
    share, violations = system.peaks.GetOutputPort("joint_peaks").Eval(peaks)
    return {
        "placed_times": system.monitor.GetOutputPort("placed_times").Eval(monitor).copy(),
        "contact_pairs": system.station.contact_pairs,
        "peak_forces": system.peaks.GetOutputPort("peak_forces").Eval(peaks).copy(),
        "peak_joint_speed_share": float(share),
        "bound_violations": int(violations),
        "max_penetration_m": system.peaks.GetOutputPort("peak_penetration").Eval(peaks).item(),
    }
