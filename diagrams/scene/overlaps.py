"""Refuses a scene in which one body lies inside another."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from pydrake.geometry import GeometryId, QueryObject, SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context

from canal.errors import InputError
from diagrams.deformable.items import deformable_mesh
from diagrams.deformable.tet_mesh import TetMesh, embed
from diagrams.geometry.bounds import BodyBounds, extent
from diagrams.geometry.contacts import collision_shapes
from diagrams.scene.scene import Scene

OVERLAP = 0.003
"""What may lie inside another at the start [m]: a basket stands on a table, a door on its hinge."""


def check_overlaps(*, plant: MultibodyPlant, scene_graph: SceneGraph, root: Context, scene: Scene) -> None:
    """Refuse a scene in which one body lies inside another.

    Args:
        plant: finalized.
        scene_graph: of the same diagram.
        root: of that diagram, as it starts.
        scene: what was added.

    Raises:
        InputError: names the two, and how deep.
    """
    query = scene_graph.get_query_output_port().Eval(scene_graph.GetMyContextFromRoot(root))
    solids: list[tuple[str, list[GeometryId]]] = [("lio", collision_shapes(plant, [scene.lio]))]
    for name, models in scene.fixtures.items():
        solids += [(name, collision_shapes(plant, [model])) for model in models]
    solids += [(i.name, list(plant.GetCollisionGeometriesForBody(i.body))) for i in scene.rigid_items]
    _check_solids(query, solids)
    context = plant.GetMyContextFromRoot(root)
    _check_cloth(query, solids, {i.name: deformable_mesh(plant, context, i) for i in scene.deformable_items})


def _check_solids(query: QueryObject, solids: list[tuple[str, list[GeometryId]]]) -> None:
    inspector = query.inspector()
    boxes = {}
    for _, geometries in solids:
        for g in geometries:
            shape = extent(inspector, g)
            # An extent is in the body's frame.
            X_WP = query.GetPoseInWorld(inspector.GetFrameId(g))
            boxes[g] = None if shape is None else np.split(BodyBounds([[shape]])([X_WP])[0], 2)
    for (name_a, of_a), (name_b, of_b) in combinations(solids, 2):
        _refuse(name_b, name_a, max((_depth(query, boxes, a, b) for a in of_a for b in of_b), default=0.0))


def _check_cloth(query: QueryObject, solids: list[tuple[str, list[GeometryId]]], cloth: dict[str, TetMesh]) -> None:
    owner = {g: name for name, geometries in solids for g in geometries}
    for name, mesh in cloth.items():
        for point in _points_within(mesh):
            for near in query.ComputeSignedDistanceToPoint(point, -OVERLAP):
                if near.id_G in owner:
                    _refuse(name, owner[near.id_G], -near.distance)
    for (name_a, a), (name_b, b) in combinations(cloth.items(), 2):
        if any((embed(outer, inner.vertices)[1] >= 0.0).all(axis=1).any() for outer, inner in ((a, b), (b, a))):
            raise InputError(f"{name_b!r} lies inside {name_a!r}: move one of them")


def _points_within(mesh: TetMesh) -> np.ndarray:
    """Along every edge, some 10 mm apart: a wall that is thinner than a tetrahedron may lie between nodes. (n, 3)."""
    edges = np.unique(np.sort(mesh.tetrahedra[:, list(combinations(range(4), 2))].reshape(-1, 2), axis=1), axis=0)
    a, b = mesh.vertices[edges[:, 0]], mesh.vertices[edges[:, 1]]
    between = [a + share * (b - a) for share in (0.25, 0.5, 0.75)]
    return np.concatenate([mesh.vertices, *between])


def _refuse(inner: str, outer: str, depth: float) -> None:
    if depth > OVERLAP:
        raise InputError(
            f"{inner!r} lies {1e3 * depth:.1f} mm inside {outer!r}; at most {1e3 * OVERLAP:.0f} mm is accepted: "
            "move one of them"
        )


def _depth(query: QueryObject, boxes: dict, a: GeometryId, b: GeometryId) -> float:
    if boxes[a] is None or boxes[b] is None:
        return 0.0
    (low_a, high_a), (low_b, high_b) = boxes[a], boxes[b]
    if np.any(low_a > high_b - OVERLAP) or np.any(low_b > high_a - OVERLAP):
        return 0.0
    return -query.ComputeSignedDistancePairClosestPoints(a, b).distance
