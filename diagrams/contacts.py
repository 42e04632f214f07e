"""What can touch, and the contacts of a step, of whatever kind."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from pydrake.geometry import GeometryId
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex


def collision_shapes(plant: MultibodyPlant, models: Iterable[ModelInstanceIndex]) -> list[GeometryId]:
    """Shapes that touch, of all bodies of some models."""
    bodies = [plant.get_body(index) for model in models for index in plant.GetBodyIndices(model)]
    return [shape for body in bodies for shape in plant.GetCollisionGeometriesForBody(body)]


def each_contact(results: ContactResults) -> Iterator[tuple[GeometryId, GeometryId, np.ndarray]]:
    """Two shapes that touch and the force on the first in W [N], shape (3,); a pair may come more than once."""
    for k in range(results.num_point_pair_contacts()):
        point = results.point_pair_contact_info(k)
        yield point.point_pair().id_B, point.point_pair().id_A, point.contact_force()
    for k in range(results.num_hydroelastic_contacts()):
        patch = results.hydroelastic_contact_info(k)
        surface = patch.contact_surface()
        yield surface.id_M(), surface.id_N(), patch.F_Ac_W().translational()
    for k in range(results.num_deformable_contacts()):
        cloth = results.deformable_contact_info(k)
        yield cloth.id_A(), cloth.id_B(), cloth.F_Ac_W().translational()
