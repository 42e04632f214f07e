"""How the Lio's gripper stands to a table: which way it leans, opens, and how deep its fingers reach."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.framework import DiagramBuilder
from scipy.spatial.transform import Rotation

from diagrams.geometry.bounds import extent
from models import BASE_FRAME, LIO_URDF, TCP_FRAME

FINGERS = ("lio_finger_left", "lio_finger_right")
ANGLES = np.linspace(0.0, 0.5236, 5)
"""Of the fingers, from closed to open [rad]."""


def tool_axes(orientation: np.ndarray) -> np.ndarray:
    """R_BT, whose columns are x_T (out of the gripper), y_T (as the fingers move) and z_T in B. Shape (3, 3)."""
    return Rotation.from_quat(orientation, scalar_first=True).as_matrix()


def lean(orientation: np.ndarray) -> float:
    """Angle between where the gripper points (x_T) and straight down [rad]; `orientation` is (w, x, y, z), in B."""
    return math.acos(min(1.0, max(-1.0, -float(tool_axes(orientation)[2, 0]))))


def opens_towards(orientation: np.ndarray) -> float:
    """Direction in which the fingers move (y_T), about z_B, in [0, π) rad; `orientation` is (w, x, y, z)."""
    x, y, _ = tool_axes(orientation)[:, 1]
    return math.atan2(y, x) % math.pi


def gripper_depth(orientation: np.ndarray) -> float:
    """How far the fingers reach below the TCP [m], however wide they are; `orientation` is (w, x, y, z), in B."""
    return float(-(_finger_corners() @ tool_axes(orientation)[2]).min())


@cache
def _finger_corners() -> np.ndarray:
    """Corners of the fingers' shapes in T, at several angles [m]. Shape (n, 3)."""
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, 0.0)
    Parser(plant).AddModels(str(LIO_URDF))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(BASE_FRAME))
    plant.Finalize()
    diagram = builder.Build()
    context = plant.GetMyContextFromRoot(diagram.CreateDefaultContext())
    inspector = scene_graph.model_inspector()
    corners = []
    for angle in ANGLES:
        for name in FINGERS:
            plant.GetJointByName(name).set_angle(context, angle)
        X_TW = plant.GetBodyByName(TCP_FRAME).EvalPoseInWorld(context).inverse()
        for body in map(plant.GetBodyByName, FINGERS):
            X_TF = X_TW.multiply(body.EvalPoseInWorld(context))
            for geometry in plant.GetCollisionGeometriesForBody(body):
                shape = extent(inspector, geometry)  # boxes and hulls: their points are all there is
                assert shape is not None
                corners.append(X_TF.multiply(shape.points.T).T)
    return np.concatenate(corners)
