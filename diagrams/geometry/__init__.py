"""Shapes, bounds, goals, contacts and poses as vectors: what several rooms share."""

from diagrams.geometry.bounds import BodyBounds, BodyBoxes, Boxes, Extent, extent
from diagrams.geometry.box_depth import FixedBoxes
from diagrams.geometry.contacts import collision_shapes, each_contact, is_contact, is_rigid_contact
from diagrams.geometry.goals import DrumGoal, Goal, MarkGoal
from diagrams.geometry.pose_vector import pose_to_vector

__all__ = [
    "BodyBounds",
    "BodyBoxes",
    "Boxes",
    "DrumGoal",
    "Extent",
    "FixedBoxes",
    "Goal",
    "MarkGoal",
    "collision_shapes",
    "each_contact",
    "extent",
    "is_contact",
    "is_rigid_contact",
    "pose_to_vector",
]
