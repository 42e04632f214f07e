"""Laundry: tetrahedral meshes, their contact, and the finer surface that is drawn and looked at."""

from diagrams.deformable.contact import MARGIN, prepare_for_cloth
from diagrams.deformable.items import (
    SoftItem,
    SoftMaterial,
    add_soft_item,
    drake_mesh,
    node_masses,
    soft_mesh,
    soft_positions,
    soft_velocities,
)
from diagrams.deformable.laundry import SoftShape, make_shape
from diagrams.deformable.tet_mesh import TetMesh, embed
from diagrams.deformable.view import SoftView

__all__ = [
    "MARGIN",
    "SoftItem",
    "SoftMaterial",
    "SoftShape",
    "SoftView",
    "TetMesh",
    "add_soft_item",
    "drake_mesh",
    "embed",
    "make_shape",
    "node_masses",
    "prepare_for_cloth",
    "soft_mesh",
    "soft_positions",
    "soft_velocities",
]
