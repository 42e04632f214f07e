"""Collision avoidance: a sweep whose unconstrained optimum goes 40 mm into a wall, followed at the margin."""

from __future__ import annotations

import time

import numpy as np
from pydrake.geometry import Box, Shape
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction, MultibodyPlant
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.framework import Diagram, DiagramBuilder

from benchmarks.ik.cases import DT, pose_of
from benchmarks.table import Row
from diagrams.ik.options import CollisionAvoidanceOptions, IkOptions
from diagrams.ik.solver import IkSolver
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant
from models import BASE_FRAME, LIO_URDF

MARGIN = 0.02
"""[m]"""
Q_FRONT = np.array([-1.6, -0.8, 1.9, 0.0, 0.6, 0.0])
"""Reaching forwards, x_T = 0.48 m. [rad]"""
WALL_X = 0.60
"""Where the wall's near face lies [m]."""
DEEP = WALL_X + 0.015
"""How far the tool is asked to go [m]: the open fingers' tips go before its point, 40 mm into the wall."""
_WEIGHT = 15.0
_ROUNDS = 5


def arm_and(shape: Shape, p: list[float]) -> tuple[MultibodyPlant, Diagram]:
    """The Lio and one solid body, welded at p [m]."""
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
    Parser(plant).AddModels(str(LIO_URDF))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(BASE_FRAME))
    model = plant.AddModelInstance("obstacle")
    body = plant.AddRigidBody("obstacle", model, SpatialInertia.SolidBoxWithMass(1.0, 0.1, 0.1, 0.1))
    plant.RegisterCollisionGeometry(body, RigidTransform(), shape, "obstacle", CoulombFriction(0.5, 0.5))
    plant.WeldFrames(plant.world_frame(), body.body_frame(), RigidTransform(p))
    plant.Finalize()
    return plant, builder.Build()


def solver_beside_wall() -> IkSolver:
    """A solver that avoids the wall."""
    plant, diagram = arm_and(Box(0.2, 2.0, 2.0), [WALL_X + 0.1, 0.0, 1.0])
    collision_avoidance = CollisionAvoidanceOptions(margin=MARGIN, solid_bodies=["obstacle"])
    return IkSolver(plant, TCP_FRAME, IkOptions(collision_avoidance=collision_avoidance), diagram=diagram)


def deep_path(reach: float = DEEP) -> list[np.ndarray]:
    """Targets that sweep past the wall, from 0.48 m in x to `reach` and back, with the gripper forwards."""
    start = pose_of(IkSolver(make_arm_plant(), TCP_FRAME), Q_FRONT)
    path = []
    for share in 0.5 - 0.5 * np.cos(np.linspace(0.0, 2.0 * np.pi, 400)):
        X = start.copy()
        X[0] += share * (reach - start[0])
        X[1:3] += np.array([0.1, -0.05]) * share
        path.append(X)
    return path


def least_distance(solver: IkSolver, q: np.ndarray) -> float:
    """Of a watched pair, at posture q (n,) [m]; 0.1 when none is nearer."""
    assert solver.clearance is not None
    solver.kinematics.set(q)
    return float(solver.clearance.near(0.1 - MARGIN).distances.min(initial=0.1))


def collision_avoidance() -> list[Row]:
    """Times of whole ticks along the sweep, how near it comes, and how deep the arm would go blind."""
    solver, blind = solver_beside_wall(), IkSolver(make_arm_plant(), TCP_FRAME)
    path = deep_path()
    q, deepest = Q_FRONT, np.inf
    for X in path:
        q = blind.solve(X, _WEIGHT, q, DT).q
        deepest = min(deepest, least_distance(solver, q))
    times, nearest, violation = [], np.inf, 0.0
    for _ in range(_ROUNDS):
        q, v = Q_FRONT, np.zeros(solver.n)
        for X in path:
            begin = time.perf_counter()
            result = solver.solve(X, _WEIGHT, q, DT, v)
            times.append(time.perf_counter() - begin)
            q, v = result.q, (result.q - q) / DT
            violation = max(violation, result.bound_violation)
            nearest = min(nearest, least_distance(solver, q))
    assert solver.clearance is not None
    figures = {
        ("watched pairs", "1"): solver.clearance.pairs,
        ("least distance", "mm"): 1e3 * nearest,
        ("least distance without", "mm"): 1e3 * deepest,
        ("bound violation max", "rad"): violation,
        ("time median", "us"): 1e6 * float(np.median(times)),
        ("time p99", "us"): 1e6 * float(np.percentile(times, 99)),
    }
    return [Row("keeping clear", "this", metric, value, unit) for (metric, unit), value in figures.items()]
