"""What can touch, and the contacts of a step, of whatever kind."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np
from pydrake.geometry import GeometryId
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex


def collision_shapes(plant: MultibodyPlant, models: Iterable[ModelInstanceIndex]) -> list[GeometryId]:
    """Shapes that touch, of all bodies of some models.

    Args:
        plant: finalized or not.
        models: instances.
    """
    bodies = [plant.get_body(index) for model in models for index in plant.GetBodyIndices(model)]
    return [shape for body in bodies for shape in plant.GetCollisionGeometriesForBody(body)]


def is_rigid_contact(results: ContactResults) -> bool:
    """Whether anything rigid touches anything rigid: a tenth of the time of looking through what touches."""
    return bool(results.num_point_pair_contacts() or results.num_hydroelastic_contacts())


def is_contact(results: ContactResults) -> bool:
    """Whether anything touches anything."""
    return is_rigid_contact(results) or bool(results.num_deformable_contacts())


def each_contact(
    results: ContactResults, concerns: Callable[[GeometryId, GeometryId], bool] = lambda a, b: True
) -> Iterator[tuple[GeometryId, GeometryId, np.ndarray]]:
    """What touches in a step, and how hard.

    Args:
        results: of the plant.
        concerns: whether two shapes are of interest; asked before their force is computed.

    Yields:
        Two shapes and the force on the first in W [N], shape (3,); a pair may come more than once.
    """
    for k in range(results.num_point_pair_contacts()):
        point = results.point_pair_contact_info(k)
        a, b = point.point_pair().id_B, point.point_pair().id_A
        if concerns(a, b):
            yield a, b, point.contact_force()
    for k in range(results.num_hydroelastic_contacts()):
        patch = results.hydroelastic_contact_info(k)
        surface = patch.contact_surface()
        a, b = surface.id_M(), surface.id_N()
        if concerns(a, b):
            yield a, b, patch.F_Ac_W().translational()
    for k in range(results.num_deformable_contacts()):
        cloth = results.deformable_contact_info(k)
        a, b = cloth.id_A(), cloth.id_B()
        if concerns(a, b):
            yield a, b, cloth.F_Ac_W().translational()
