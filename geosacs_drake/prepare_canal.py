"""What a run is built from: its scenario, and its canal, loaded or learned, bent to where the task is now."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from canal.demonstration import load_demonstration
from canal.editing import with_support_planes
from canal.learning import learn_canal
from canal.retargeting import retarget
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface
from canal.surface_file import load_canal
from diagrams.fitted_scene import fit_scene
from diagrams.scenario import Retarget, Scenario
from diagrams.scene.leads_to import check_leads_to_items
from diagrams.station.lio_ik import make_lio_solver
from geosacs_drake.run_options import RunOptions
from models import MODELS


def prepare_task(scenario: Scenario, options: RunOptions) -> tuple[Scenario, CanalSurface]:
    """The canal of a run, and the scenario that it leads through; what a person should know goes to stderr.

    A relocation by somebody's own canal, without a scenario, gets a scene that is fitted to it.

    Args:
        scenario: the task's own, or the one that the options name.
        options: of the run.

    Raises:
        InputError: a file cannot be used, or the canal does not lead to the scenario's items.
    """
    if (options.canal or options.demos) and not options.scenario and scenario.task == "relocation":
        template = replace(scenario, support_planes=[], retarget=Retarget())
        fitted = fit_scene(prepare_canal(template, options), template, make_lio_solver(template, template.ik))
        for line in fitted.lines:
            print(line, file=sys.stderr)
        return fitted.scenario, fitted.canal
    canal = prepare_canal(scenario, options)
    check_leads_to_items(scenario, canal, options.seed or 0)
    return scenario, canal


def prepare_canal(scenario: Scenario, options: RunOptions) -> CanalSurface:
    """The canal that the options or the scenario name: loaded, or learned; moved to where the task is now.

    It is refined at the scenario's support planes, a loaded one also at its own.

    Args:
        scenario: the task.
        options: of the run.

    Raises:
        InputError: a file cannot be used, or the canal passes beyond a support plane.
    """
    planes = scenario.learning.support_planes + tuple(scenario.support_planes)
    canal = _load_or_learn(scenario, options, planes)
    if scenario.retarget != Retarget():
        to = scenario.retarget
        pick = _moved(canal, 0, to.pick, to.pick_yaw_deg)
        place = _moved(canal, -1, to.place, to.place_yaw_deg)
        canal = retarget(canal, pick, place, support_planes=planes or None)
    for warning in canal.warnings:
        print(f"canal: {warning}", file=sys.stderr)
    return canal


def _moved(canal: CanalSurface, disk: int, pose: list[float], yaw_deg: float) -> np.ndarray:
    """The pose of an end of the canal with what is given in its place, turned about the vertical. Shape (7,)."""
    own = np.concatenate([canal.directrix[disk], canal.orientations[disk]])
    own[: len(pose)] = pose
    turn = Rotation.from_euler("z", yaw_deg, degrees=True)
    own[3:] = (turn * Rotation.from_quat(own[3:], scalar_first=True)).as_quat(scalar_first=True)
    return own


def _load_or_learn(scenario: Scenario, options: RunOptions, planes: tuple[SupportPlane, ...]) -> CanalSurface:
    path = options.canal
    if path is None and not options.demos and scenario.canal is not None:
        path = scenario.resolve(scenario.canal, MODELS / "demonstrations")
    # Where the task has moved, the planes are where it is now; the canal is learned where it was shown.
    planes = planes if scenario.retarget == Retarget() else ()
    if path is not None:
        return with_support_planes(load_canal(path), planes)
    demonstrations: list[Path] = list(options.demos) or [
        scenario.resolve(name, MODELS / "demonstrations") for name in scenario.demonstrations
    ]
    learning = replace(scenario.learning, support_planes=planes)
    return learn_canal([load_demonstration(path) for path in demonstrations], learning)
