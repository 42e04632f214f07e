"""Laundry: tetrahedral meshes, their contact, and the finer surface that is drawn and looked at."""

from diagrams.deformable.contact import MARGIN, prepare_for_cloth
from diagrams.deformable.items import (
    DeformableItem,
    DeformableMaterial,
    add_deformable_item,
    deformable_mesh,
    deformable_positions,
    deformable_velocities,
    drake_mesh,
    node_masses,
)
from diagrams.deformable.laundry import DeformableShape, make_shape
from diagrams.deformable.tet_mesh import TetMesh, embed
from diagrams.deformable.view import DeformableView

__all__ = [
    "MARGIN",
    "DeformableItem",
    "DeformableMaterial",
    "DeformableShape",
    "DeformableView",
    "TetMesh",
    "add_deformable_item",
    "deformable_mesh",
    "deformable_positions",
    "deformable_velocities",
    "drake_mesh",
    "embed",
    "make_shape",
    "node_masses",
    "prepare_for_cloth",
]
