"""The canal of a run: loaded, or learned from demonstrations, and bent to where the task is now."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.refinement import SupportPlane
from canal.retargeting import retarget
from canal.surface import CanalSurface
from diagrams.scenario import Retarget, Scenario
from geosacs_drake.options import RunOptions
from models import MODELS


def prepare_canal(scenario: Scenario, options: RunOptions) -> CanalSurface:
    """The canal that the options or the scenario name: loaded, or learned; moved to where the task is now."""
    planes = tuple(scenario.support_planes)
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
    if options.canal is not None:
        return CanalSurface.load(options.canal)
    if not options.demos and scenario.canal is not None:
        return CanalSurface.load(scenario.resolve(scenario.canal, MODELS / "demonstrations"))
    paths: list[Path] = list(options.demos) or [
        scenario.resolve(name, MODELS / "demonstrations") for name in scenario.demonstrations
    ]
    learning = replace(scenario.learning, support_planes=scenario.learning.support_planes + planes)
    return learn_canal([load_demonstration(path) for path in paths], learning)
