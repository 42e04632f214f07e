"""Deformable items in a MultibodyPlant: register them before Finalize, read them from a Context after.

The material is a linear corotated solid with stiffness-proportional damping. Its numbers come from
`benchmarks/bench_soft.py` (table in build/bench-soft.csv): at 3 kPa the fingers squeeze through and drop it, at 20 kPa
nothing sags; less damping makes a step dearer, more changes little.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    GeometryId,
    GeometryInstance,
    IllustrationProperties,
    InMemoryMesh,
    Mesh,
    PerceptionProperties,
    ProximityProperties,
    Rgba,
    Sphere,
)
from pydrake.math import RigidTransform
from pydrake.multibody.fem import DeformableBodyConfig, MaterialModel
from pydrake.multibody.plant import CoulombFriction, MultibodyPlant
from pydrake.multibody.tree import DeformableBodyId
from pydrake.systems.framework import Context

from diagrams.deformable.laundry import DeformableShape
from diagrams.deformable.render_mesh import write_render_mesh
from diagrams.deformable.tet_mesh import TetMesh


@dataclass(frozen=True)
class DeformableMaterial:
    """What an item is made of.

    Attributes:
        youngs_modulus: stiffness of the bulk (cloth with air in its folds), [Pa].
        poissons_ratio: small, since gathered cloth hardly widens when it is squeezed.
        stiffness_damping: Rayleigh coefficient, [s].
        mass_damping: Rayleigh coefficient, [1/s]. It stands for the air: nothing falls faster than g / 5 = 2 m/s, about
            what a shirt does that is dropped open.
        friction: Coulomb coefficient, static = dynamic. Drake combines two surfaces as 2 a b / (a + b).
        model: of the material: `linear_corotated`, `corotated` or `neohookean`.
    """

    youngs_modulus: float = 8.0e3
    poissons_ratio: float = 0.2
    stiffness_damping: float = 0.05
    mass_damping: float = 5.0
    friction: float = 0.7
    model: str = "linear_corotated"


_MODELS = {
    "linear_corotated": MaterialModel.kLinearCorotated,
    "corotated": MaterialModel.kCorotated,
    "neohookean": MaterialModel.kNeoHookean,
}


@dataclass(frozen=True)
class DeformableItem:
    """A registered item: its shape and the handles to find it in a Context."""

    name: str
    shape: DeformableShape
    body_id: DeformableBodyId
    geometry_id: GeometryId
    collision_proxy_id: GeometryId
    """Of a solid fixed to the world that takes the item's shape while it sleeps (`diagrams.station.sleeping_item`)."""


def add_deformable_item(
    *,
    plant: MultibodyPlant,
    name: str,
    shape: DeformableShape,
    X_WP: RigidTransform,
    material: DeformableMaterial | None = None,
    filmed: bool = False,
) -> DeformableItem:
    """Register an item with a plant that is not yet finalized; P is the frame of the shape at rest.

    Drake's own Meshcat drawing of the coarse mesh is hidden; `deformable_view` draws the fine surface. Cameras see
    it too where an item is `filmed` (that takes a second to prepare), else the solid in its mean colour.

    Args:
        plant: before it is finalized.
        name: of the system.
        shape: the item at rest.
        X_WP: where it lies.
        material: None for the item's own.
        filmed: whether cameras will look at it.
    """
    material = material or DeformableMaterial()
    config = DeformableBodyConfig()
    config.set_youngs_modulus(material.youngs_modulus)
    config.set_poissons_ratio(material.poissons_ratio)
    config.set_stiffness_damping_coefficient(material.stiffness_damping)
    config.set_mass_damping_coefficient(material.mass_damping)
    config.set_mass_density(shape.density())
    config.set_material_model(_MODELS[material.model])
    geometry = GeometryInstance(X_WP, drake_mesh(shape.mesh, name), name)
    properties = ProximityProperties()
    AddContactMaterial(properties=properties, friction=CoulombFriction(material.friction, material.friction))
    geometry.set_proximity_properties(properties)
    hidden = IllustrationProperties()
    hidden.AddProperty("meshcat", "accepting", "nobody")  # a visualizer draws what names its prefix, or no prefix
    geometry.set_illustration_properties(hidden)
    with ExitStack() as cleanup:
        seen = PerceptionProperties()
        if filmed:
            folder = cleanup.enter_context(TemporaryDirectory())  # read once, when the body is registered
            surface = Path(folder) / f"{shape.kind}.obj"
            write_render_mesh(shape, surface)
            seen.AddProperty("deformable", "embedded_mesh", str(surface))
        else:
            seen.AddProperty("phong", "diffuse", Rgba(*shape.surface.colors.mean(axis=0), 1.0))
        geometry.set_perception_properties(seen)
        model = plant.mutable_deformable_model()
        body_id = model.RegisterDeformableBody(geometry, config, 1.0)  # the hint is ignored for a mesh
    solid = ProximityProperties()
    AddContactMaterial(properties=solid, friction=CoulombFriction(material.friction, material.friction))
    AddCompliantHydroelasticProperties(PROXY_RADIUS, PROXY_MODULUS, solid)
    world, out_of_the_way = plant.world_body(), RigidTransform([0.0, 0.0, -1.0])
    collision_proxy_id = plant.RegisterCollisionGeometry(
        world, out_of_the_way, Sphere(PROXY_RADIUS), f"{name}_proxy", solid
    )
    return DeformableItem(name, shape, body_id, model.GetGeometryId(body_id), collision_proxy_id)


PROXY_RADIUS = 0.03
"""Of the ball that a collision proxy is before the item first sleeps [m]: half as thick as an item, so that the contact
gradient of what cloth meets (`diagrams.deformable.contact`) is that of the proxy too."""
PROXY_MODULUS = 1e6
"""[Pa]; set anew with the gradient of the surroundings."""


def drake_mesh(mesh: TetMesh, name: str) -> Mesh:
    """A solid of tetrahedra as Drake takes it, without a file.

    Args:
        mesh: the solid.
        name: of the system.
    """
    return Mesh(InMemoryMesh(mesh_file=MemoryFile(mesh.to_vtk(), ".vtk", f"{name}.vtk")))


def deformable_positions(plant: MultibodyPlant, context: Context, item: DeformableItem) -> np.ndarray:
    """Node positions p_WN in [m], shape (N, 3).

    Args:
        plant: finalized.
        context: of the plant.
        item: one of the plant's.
    """
    return plant.deformable_model().GetPositions(context, item.body_id).T


def deformable_mesh(plant: MultibodyPlant, context: Context, item: DeformableItem) -> TetMesh:
    """The tetrahedra as they lie now, in W [m].

    Args:
        plant: finalized.
        context: of the plant.
        item: one of the plant's.
    """
    return TetMesh(deformable_positions(plant, context, item), item.shape.mesh.tetrahedra)


def deformable_velocities(plant: MultibodyPlant, context: Context, item: DeformableItem) -> np.ndarray:
    """Node velocities v_WN in [m/s], shape (N, 3).

    Args:
        plant: finalized.
        context: of the plant.
        item: one of the plant's.
    """
    return plant.deformable_model().GetVelocities(context, item.body_id).T


def node_masses(shape: DeformableShape) -> np.ndarray:
    """Lumped masses in [kg], shape (N,): a quarter of each tetrahedron to each corner, as in the solver."""
    masses = np.zeros(len(shape.mesh.vertices))
    share = shape.density() * shape.mesh.volumes() / 4.0
    np.add.at(masses, shape.mesh.tetrahedra, share[:, None])
    return masses
