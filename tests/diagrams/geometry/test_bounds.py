"""Bounds of shapes against points of their surfaces."""

import numpy as np
import pytest
from pydrake.geometry import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    GeometryInstance,
    ProximityProperties,
    SceneGraph,
    Sphere,
)
from pydrake.math import RigidTransform, RotationMatrix
from scipy.spatial.transform import Rotation

from diagrams.geometry.bounds import BodyBounds, BodyBoxes, Extent, extent


def pose(seed):
    rng = np.random.default_rng(seed)
    return RigidTransform(RotationMatrix(Rotation.random(rng=rng).as_matrix()), rng.uniform(-1, 1, 3))


def surface(shape):
    """Points on a shape, dense enough for 2 mm."""
    t, p = (a.ravel() for a in np.meshgrid(np.linspace(0, 2 * np.pi, 181), np.linspace(0, np.pi, 91)))
    ball = np.stack([np.sin(p) * np.cos(t), np.sin(p) * np.sin(t), np.cos(p)], axis=1)
    if isinstance(shape, Box):
        return np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * shape.size() / 2
    if isinstance(shape, Ellipsoid):
        return ball * [shape.a(), shape.b(), shape.c()]
    if isinstance(shape, Sphere):
        return ball * shape.radius()
    ring = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1) if isinstance(shape, Cylinder) else ball
    return np.vstack([ring * shape.radius() + [0, 0, s * shape.length() / 2] for s in (-1, 1)])


@pytest.mark.parametrize(
    "shape", [Box(0.1, 0.2, 0.3), Ellipsoid(0.1, 0.2, 0.05), Sphere(0.1), Cylinder(0.05, 0.3), Capsule(0.05, 0.3)],
    ids=lambda s: type(s).__name__,
)  # fmt: skip
@pytest.mark.parametrize("seed", range(3))
def test_bounds_are_tight(shape, seed):
    scene_graph = SceneGraph()
    source = scene_graph.RegisterSource("test")
    X_PG, X_WP = pose(seed), pose(seed + 100)
    instance = GeometryInstance(X_PG, shape, "shape")
    instance.set_proximity_properties(ProximityProperties())
    geometry = scene_graph.RegisterAnchoredGeometry(source, instance)
    (bounds,) = BodyBounds([[extent(scene_graph.model_inspector(), geometry)]])([X_WP])
    points = X_WP.multiply(X_PG).multiply(surface(shape).T).T
    assert np.all(points >= bounds[:3] - 1e-9)
    assert np.all(points <= bounds[3:] + 1e-9)
    assert bounds[:3] == pytest.approx(points.min(axis=0), abs=2e-3)
    assert bounds[3:] == pytest.approx(points.max(axis=0), abs=2e-3)


def test_a_body_is_the_union_of_its_shapes():
    balls = [Extent(np.array([[x, 0.0, 0.0]]), 0.1 * np.eye(3)) for x in (0.0, 1.0, 5.0)]
    bounds = BodyBounds([balls[:2], balls[2:]])([RigidTransform([0, 0, 1.0]), RigidTransform([0, 2.0, 0])])
    assert bounds == pytest.approx(np.array([[-0.1, -0.1, 0.9, 1.1, 0.1, 1.1], [4.9, 1.9, -0.1, 5.1, 2.1, 0.1]]))


@pytest.mark.parametrize("seed", range(5))
def test_quick_bounds_hold_the_tight_ones(seed):
    rng = np.random.default_rng(seed)
    bodies = [[Extent(rng.normal(size=(7, 3)), 0.3 * rng.normal(size=(3, 3))) for _ in range(2)] for _ in range(4)]
    poses = [pose(k) for k in range(4)]
    tight, quick = BodyBounds(bodies)(poses), BodyBoxes(bodies)(poses).bounds()
    assert np.all(quick[:, :3] <= tight[:, :3] + 1e-12)
    assert np.all(quick[:, 3:] >= tight[:, 3:] - 1e-12)
    upright = [RigidTransform([k, 0.0, 0.0]) for k in range(4)]
    of_one = [b[:1] for b in bodies]
    assert BodyBoxes(of_one)(upright).bounds() == pytest.approx(BodyBounds(of_one)(upright))


@pytest.mark.parametrize("seed", range(20))
def test_gaps_of_turned_boxes_are_at_most_the_distance(seed):
    rng = np.random.default_rng(seed)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    halves = rng.uniform(0.05, 0.5, (2, 3))
    poses = [pose(seed), pose(seed + 50)]
    low = rng.uniform(-2, 2, (3, 3))
    bounds = np.hstack([low, low + rng.uniform(0, 1, (3, 3))])
    gaps = BodyBoxes([[Extent(corners * h, np.zeros((3, 3)))] for h in halves])(poses).gaps(bounds)
    inside = rng.uniform(-1, 1, (4000, 3))
    for n, (X, h) in enumerate(zip(poses, halves, strict=True)):
        points = X.multiply((inside * h).T).T
        for m, b in enumerate(bounds):
            distance = np.linalg.norm(np.maximum(0, np.maximum(b[:3] - points, points - b[3:])), axis=1).min()
            assert gaps[m, n] <= distance + 1e-12
            # Two boxes that only an edge of each parts are nearer by the sine of the angle than their faces tell.
            assert distance < 0.1 or gaps[m, n] > 0.4 * distance - 0.1


def test_a_turned_box_is_apart_from_what_only_its_bounds_reach():
    turned = RigidTransform(RotationMatrix.MakeZRotation(np.pi / 4), [0, 0, 0])
    (boxes,) = [BodyBoxes([[Extent(np.array([[-1.0, -0.1, -0.1], [1.0, 0.1, 0.1]]), np.zeros((3, 3)))]])([turned])]
    beside = np.array([[0.4, -0.6, -0.1, 0.6, -0.4, 0.1]])
    assert boxes.gaps(beside).item() == pytest.approx(np.sqrt(0.5) - 0.1 - 0.1 * np.sqrt(2))
