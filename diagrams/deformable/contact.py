"""Contact of cloth with rigid shapes that neither leaks nor hops.

Where cloth meets a rigid shape, Drake presses it out along the shape's pressure field, p = g · depth, with
g = hydroelastic modulus / half the thickness, and no dissipation. With the g = 3e8 Pa/m that suits rigid items, clothes
of 100 g hop at 5 ms and never come to rest (300 uJ, 4 mm of drift in 2 s; a sock goes on hopping at 6e7, too); at
3e7 Pa/m and less they lie still (0.0001 uJ, 0.01 mm), and the softer, the deeper a corner sinks in (`bench_soft`).
Half the thickness is also how deep cloth may be pushed before it would come out on the other side.

Boxes become convex hulls of the same eight corners. A box's pressure is defined on tetrahedra round its medial axis, a
hull's on two for each face that meet in its middle; each is cut with each triangle of cloth, so that the hull gives
half the contact points (77 instead of 146 for a shirt on a floor), and a step takes two thirds of the time.
"""

from __future__ import annotations

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import (
    Box,
    Capsule,
    Convex,
    Cylinder,
    Ellipsoid,
    GeometryId,
    InMemoryMesh,
    ProximityProperties,
    Role,
    RoleAssign,
    SceneGraph,
    SceneGraphInspector,
    Sphere,
)
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex

from diagrams.geometry.contacts import collision_shapes

SURROUNDINGS_GRADIENT = 3.0e7
"""g of what stands about [Pa/m]; see above."""
PAD_GRADIENT = 1.0e7
"""g of the robot's shapes [Pa/m]: the pads press with 13 kPa, and sink in by 1.3 mm."""

MARGIN = 0.001
"""How far off a surface contact is foreseen [m]. A contact point is the middle of the part of a triangle that is nearer
than this, so that a corner that points down lies as deep as twice the margin before anything holds it: 8 mm at rest
with 5 mm. What falls at 1 m/s sinks in by what it falls in a step, less the margin: a towel that topples, with steps of
5 ms, by 5.0 mm with 1 mm, 5.2 with 1.5, 5.4 with 2."""


def prepare_for_cloth(
    *,
    plant: MultibodyPlant,
    scene_graph: SceneGraph,
    robot: ModelInstanceIndex,
    fallen_into: list[ModelInstanceIndex],
    surroundings: float = SURROUNDINGS_GRADIENT,
    pads: float = PAD_GRADIENT,
    margin: float = MARGIN,
) -> None:
    """Give every rigid shape the pressure gradient that suits cloth; before the plant is finalized.

    Contact is foreseen at the models that cloth falls into, and not elsewhere, since that takes twice as many points.
    Whether a shape is compliant towards rigid ones stays as it is. Shapes without a thickness (meshes) stay too.

    Args:
        plant: before it is finalized.
        scene_graph: that the plant is registered with.
        robot: the Lio's model.
        fallen_into: models at which contact is foreseen.
        surroundings: pressure gradient of the other shapes, [Pa/m].
        pads: pressure gradient of the robot's shapes, [Pa/m].
        margin: at which contact is foreseen, [m].
    """
    inspector = scene_graph.model_inspector()
    links, deep = (set(collision_shapes(plant, models)) for models in ([robot], fallen_into))
    for geometry in inspector.GetAllGeometryIds(Role.kProximity):
        if inspector.IsDeformableGeometry(geometry):
            continue
        depth = half_thickness(inspector, geometry)
        if not np.isfinite(depth):
            continue
        gradient = pads if geometry in links else surroundings
        properties = ProximityProperties(inspector.GetProximityProperties(geometry))
        properties.UpdateProperty("hydroelastic", "hydroelastic_modulus", gradient * depth)
        properties.UpdateProperty("hydroelastic", "margin", margin if geometry in deep else 0.0)
        scene_graph.AssignRole(plant.get_source_id(), geometry, properties, RoleAssign.kReplace)
        shape = inspector.GetShape(geometry)
        if isinstance(shape, Box):
            scene_graph.ChangeShape(plant.get_source_id(), geometry, hull_of_box(np.array(shape.size())))


_FACES = np.array(
    [[1, 3, 2], [2, 3, 4], [5, 6, 7], [6, 8, 7], [1, 2, 5], [2, 6, 5], [3, 7, 4], [4, 7, 8], [1, 5, 3], [3, 5, 7]]
    + [[2, 4, 6], [4, 8, 6]]
)
"""Of a box whose corners are numbered from 1 as x, then y, then z goes from low to high, z fastest."""


def hull_of_box(size: np.ndarray) -> Convex:
    """A box of the given edges (3,) [m] as a convex hull."""
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)] * size
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in corners] + [f"f {a} {b} {c}" for a, b, c in _FACES]
    return Convex(InMemoryMesh(mesh_file=MemoryFile("\n".join(lines), ".obj", "box.obj")), 1.0)


def half_thickness(inspector: SceneGraphInspector, geometry: GeometryId) -> float:
    """Depth of the middle of a convex shape below its surface [m]; infinite for a mesh, which has none.

    Args:
        inspector: of the scene graph.
        geometry: one that has a proximity role.
    """
    shape = inspector.GetShape(geometry)
    if isinstance(shape, Box):
        return float(min(shape.size())) / 2.0
    if isinstance(shape, Sphere | Capsule):
        return float(shape.radius())
    if isinstance(shape, Cylinder):
        return min(float(shape.radius()), float(shape.length()) / 2.0)
    if isinstance(shape, Ellipsoid):
        return min(float(shape.a()), float(shape.b()), float(shape.c()))
    if isinstance(shape, Convex):
        hull = shape.GetConvexHull()
        normals = np.array([hull.face_normal(i) for i in range(hull.num_elements())])
        corners = np.array([hull.vertex(hull.element(i).vertex(0)) for i in range(hull.num_elements())])
        return float(np.min(np.sum(normals * (corners - hull.centroid()), axis=1)))
    return float("inf")
