"""What a command is to run: scenario, canal, seed and duration, from its options or from the log that it replays."""

from __future__ import annotations

import sys
from copy import deepcopy
from dataclasses import dataclass, replace

from canal.surface import CanalSurface
from diagrams.scenario import Scenario, load_scenario, with_items
from geosacs_drake.prepare_canal import prepare_task
from geosacs_drake.replay import Origin, differences, load_origin
from geosacs_drake.run_files import check_run_files
from geosacs_drake.run_options import RunOptions

DURATION_S = 900.0
"""Longest simulated time of a run that is not told."""


@dataclass(frozen=True)
class RunTask:
    """What is to be run."""

    scenario: Scenario
    name: str
    """Of the scenario, for a person."""
    canal: CanalSurface
    seed: int
    duration: float
    """Longest simulated time [s]."""


def find_task(options: RunOptions, task: str, prog: str) -> RunTask:
    """Load, learn and check what is to be run; what a person should know of it goes to stderr.

    Args:
        options: of the command.
        task: whose scenario is taken where nothing names another.
        prog: the command's name, for messages.

    Raises:
        InputError: an option or a file cannot be used, an output could not be written.
    """
    origin = load_origin(options.operator)
    seed, duration = (0, DURATION_S) if origin is None else (origin.metadata.seed, origin.metadata.duration)
    seed = seed if options.seed is None else options.seed
    duration = duration if options.duration is None else options.duration
    if origin is None or options.scenario or options.canal or options.demos:
        name = options.scenario or (task if origin is None else origin.metadata.base)
        named = _with_items(load_scenario(name), options)
        check_run_files(options, named)
        scenario, canal = prepare_task(named, replace(options, seed=seed))
        if scenario is not named:
            name = f"{name}, fitted to the canal"
    else:
        name, canal = origin.metadata.scenario_name, origin.canal
        scenario = _with_items(deepcopy(origin.metadata.scenario), options)
        check_run_files(options, scenario)
    found = RunTask(scenario, name, canal, seed, duration)
    if origin is not None:
        _tell(origin, found, options, task, prog)
    return found


def _with_items(scenario: Scenario, options: RunOptions) -> Scenario:
    return scenario if options.items is None else with_items(scenario, options.items)


def _tell(origin: Origin, found: RunTask, options: RunOptions, task: str, prog: str) -> None:
    """Say in what a replay is another run than its log's, or another than the command's name says."""
    if found.scenario.task != task:
        print(f"{prog}: {options.operator} is of a {found.scenario.task}; that is replayed", file=sys.stderr)
    others = differences(origin, seed=found.seed, scenario=found.scenario, canal=found.canal)
    if others:
        line = f"{options.operator} is replayed with {', '.join(others)}: this is another run than it was"
        print(f"{prog}: {line}", file=sys.stderr)
