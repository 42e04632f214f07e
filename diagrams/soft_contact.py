"""Contact of cloth with rigid shapes that neither leaks nor hops.

Where cloth meets a rigid shape, Drake presses it out along the shape's pressure field, p = g · depth, with
g = hydroelastic modulus / half the thickness, and no dissipation. With the g = 3e8 Pa/m that suits rigid things, pieces
of 100 g hop at 5 ms and never come to rest (456 uJ, 19 mm of drift in 2 s); at 3e6 Pa/m they lie still (0.0003 uJ,
0.01 mm) and sink in by less than 0.1 mm of their own weight, and a step costs a third (`bench_soft`).
Half the thickness is also how deep cloth may be pushed before it would come out on the other side.
"""

from __future__ import annotations

import numpy as np
from pydrake.geometry import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    GeometryId,
    ProximityProperties,
    Role,
    RoleAssign,
    SceneGraph,
    SceneGraphInspector,
    Sphere,
)
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex

SURROUNDINGS_GRADIENT = 3.0e6
"""g of what stands about [Pa/m]; see above."""
PAD_GRADIENT = 1.0e7
"""g of the robot's shapes [Pa/m]: the pads press with 13 kPa, and sink in by 1.3 mm."""

MARGIN = 0.005
"""How far off a surface contact is foreseen [m]: what falls at 2 m/s goes that far in a step of 5 ms, and without it
sinks in as deep."""


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
    """
    inspector = scene_graph.model_inspector()
    links, deep = _geometries(plant, [robot]), _geometries(plant, fallen_into)
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


def _geometries(plant: MultibodyPlant, models: list[ModelInstanceIndex]) -> set[GeometryId]:
    bodies = [plant.get_body(b) for m in models for b in plant.GetBodyIndices(m)]
    return {g for body in bodies for g in plant.GetCollisionGeometriesForBody(body)}


def half_thickness(inspector: SceneGraphInspector, geometry: GeometryId) -> float:
    """Greatest depth inside a convex shape [m]; infinite for a shape that has none."""
    shape = inspector.GetShape(geometry)
    if isinstance(shape, Box):
        return float(min(shape.size())) / 2.0
    if isinstance(shape, Sphere | Capsule):
        return float(shape.radius())
    if isinstance(shape, Cylinder):
        return min(float(shape.radius()), float(shape.length()) / 2.0)
    if isinstance(shape, Ellipsoid):
        return min(float(shape.a()), float(shape.b()), float(shape.c()))
    return float("inf")
