"""Where a table can stand under an end of a canal: it bears what lies on the disk, and the arm does not meet it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import numpy as np
from pydrake.geometry import Box, GeometryId
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
from pydrake.systems.framework import DiagramBuilder

from canal.errors import InputError
from canal.surface import CanalSurface
from diagrams.ik.reachability import ReachReport
from diagrams.scene.layout import yaw_pose
from diagrams.scene.open_gripper import ANGLES
from models import BASE_FRAME, LIO_URDF
from models.make_world import BOARD

EDGE = 0.05
"""[m] Between the middle of an item and the table's edge: all of it stands on the table."""
OUTWARDS = (0.06, 0.0, 0.12, -0.06, 0.18, 0.24)
SIDEWAYS = (0.0, 0.08, -0.08, 0.16, -0.16)
"""Of the table's middle from the disk's, away from the robot's base and across [m], in order of preference."""
FROM_BASE = 0.01
"""Least distance between a table and the robot's base, and another table [m]."""
EVERY = 4
"""Of the disks on the way, that are looked at."""


@dataclass(frozen=True)
class FittedTable:
    """A table under one end.

    Attributes:
        center: of its top, x and y in B [m].
        top: height of its top [m].
        yaw_deg: its turn about the vertical.
        free: at which of the reached points of the disk the arm does not meet it. Shape (rings, spokes).
    """

    center: tuple[float, float]
    top: float
    yaw_deg: float
    free: np.ndarray

    def room(self, start: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """How far from a point (2,) [m] items may stand in directions `angles` [rad] of B, [m]. Same shape.

        Args:
            start: in B, [m]. Shape (2,).
            angles: [rad]. Shape (k,).
        """
        yaw = math.radians(self.yaw_deg)
        c, s = math.cos(yaw), math.sin(yaw)
        x, y = np.array([[c, s], [-s, c]]) @ (start - self.center)
        u, v = np.cos(angles - yaw), np.sin(angles - yaw)
        with np.errstate(divide="ignore"):
            along = (BOARD[0] / 2 - EDGE - np.sign(u) * x) / np.abs(u)
            across = (BOARD[1] / 2 - EDGE - np.sign(v) * y) / np.abs(v)
        return np.maximum(np.minimum(along, across), 0.0)


def fit_tables(
    canal: CanalSurface, report: ReachReport, path: np.ndarray, tops: dict[str, float]
) -> dict[str, FittedTable]:
    """Choose a table for each end.

    Args:
        canal: in B.
        report: of the reach of its first and last disk.
        path: postures along the directrix, (N, n) [rad].
        tops: heights of the tables at pick and place [m].

    Returns:
        The tables, by the same names.

    Raises:
        InputError: wherever a table stands, the arm or the base meets it.
    """
    tables: dict[str, FittedTable] = {}
    for row, (name, top) in enumerate(tops.items()):
        center = canal.directrix[report.disks[row], :2]
        azimuth = math.atan2(center[1], center[0])
        shifts = list(product(OUTWARDS, SIDEWAYS))
        middles = [center + yaw_pose([0, 0, 0], azimuth).rotation().matrix()[:2, :2] @ shift for shift in shifts]
        placed = [RigidTransform(yaw_pose([*middle, top], azimuth)) for middle in middles]
        standing = [yaw_pose([*t.center, t.top], math.radians(t.yaw_deg)) for t in tables.values()]
        met_on_way, met_at_end, in_the_way = _meetings(placed, standing, path[::EVERY], report.postures[row])
        around = np.arange(24) * (2 * math.pi / 24)
        best, most = None, 0.0
        for k, middle in enumerate(middles):
            if met_on_way[k] or in_the_way[k]:
                continue
            table = FittedTable((float(middle[0]), float(middle[1])), top, math.degrees(azimuth), ~met_at_end[k])
            room = np.minimum(table.room(center, around), float(canal.radii[report.disks[row]]) + 1e-3)
            held = float((room**2).mean() * (table.free | ~report.reached[row]).mean())
            if held > 1.01 * most:
                best, most = table, held
        if best is None:
            raise InputError(
                f"a table of {top:.2f} m under the canal's {name} at ({center[0]:.2f}, {center[1]:.2f}) m would be in "
                "the way of the robot; demonstrate further from its base, or give a --scenario"
            )
        tables[name] = best
    return tables


def _meetings(
    tables: list[RigidTransform], standing: list[RigidTransform], path: np.ndarray, at_end: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What meets tables in these poses: the arm on its way (k,), at the end (k, rings, spokes); base or others (k,)."""
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, 0.0)
    (lio,) = Parser(plant).AddModels(str(LIO_URDF))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(BASE_FRAME, lio))

    def board(X: RigidTransform, name: str) -> GeometryId:
        X = X.multiply(RigidTransform([0, 0, -BOARD[2] / 2]))
        return plant.RegisterCollisionGeometry(plant.world_body(), X, Box(*BOARD), name, CoulombFriction(1, 1))

    boards = [board(X, f"candidate_{k}") for k, X in enumerate(tables)]
    others = [board(X, f"standing_{k}") for k, X in enumerate(standing)]
    others += plant.GetCollisionGeometriesForBody(plant.GetBodyByName(BASE_FRAME, lio))
    plant.Finalize()
    diagram = builder.Build()
    root = diagram.CreateDefaultContext()
    context = plant.GetMyMutableContextFromRoot(root)
    port, scene_context = scene_graph.get_query_output_port(), scene_graph.GetMyContextFromRoot(root)
    index = {board: k for k, board in enumerate(boards)}
    arm = {
        g
        for b in plant.GetBodyIndices(lio)
        if not plant.IsAnchored(plant.get_body(b))
        for g in plant.GetCollisionGeometriesForBody(plant.get_body(b))
    }

    def met(q: np.ndarray) -> np.ndarray:
        hit = np.zeros(len(boards), dtype=bool)
        for fingers in (ANGLES[0], ANGLES[-1]):
            positions = plant.GetPositions(context)
            positions[: len(q)], positions[len(q) :] = q, fingers
            plant.SetPositions(context, positions)
            for overlap in port.Eval(scene_context).ComputePointPairPenetration():
                for a, b in ((overlap.id_A, overlap.id_B), (overlap.id_B, overlap.id_A)):
                    if a in index and b in arm:
                        hit[index[a]] = True
        return hit

    on_way = np.any([met(q) for q in path], axis=0)
    rings, spokes, n = at_end.shape
    end = np.array([met(q) for q in at_end.reshape(-1, n)]).T.reshape(-1, rings, spokes)
    query = port.Eval(scene_context)
    near = [min(query.ComputeSignedDistancePairClosestPoints(b, o).distance for o in others) for b in boards]
    return on_way, end, np.array(near) < FROM_BASE
