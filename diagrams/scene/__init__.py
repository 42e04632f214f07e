"""What stands where: a world as typed data, its models checked and added to a plant, its items laid out from a seed.

A `World` is data; `add_scene` builds it, and refuses what overlaps or does not fit.
"""

from diagrams.scene.fitted_table import FittedTable, fit_tables
from diagrams.scene.layout import base_pose, draw_layout, make_goals
from diagrams.scene.leads_to import check_leads_to_items
from diagrams.scene.open_gripper import gripper_depth, lean, opens_towards, tool_axes
from diagrams.scene.overlaps import check_overlaps
from diagrams.scene.scene import RigidItem, Scene, add_scene
from diagrams.scene.world import Contact, Fixture, Item, Kind, Region, Robot, Room, World, check_world

__all__ = [
    "Contact",
    "FittedTable",
    "Fixture",
    "Item",
    "Kind",
    "Region",
    "RigidItem",
    "Robot",
    "Room",
    "Scene",
    "World",
    "add_scene",
    "base_pose",
    "check_leads_to_items",
    "check_overlaps",
    "check_world",
    "draw_layout",
    "fit_tables",
    "gripper_depth",
    "lean",
    "make_goals",
    "opens_towards",
    "tool_axes",
]
