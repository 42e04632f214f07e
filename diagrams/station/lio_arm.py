"""The Lio alone, for kinematics: what the inverse kinematics computes with."""

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import RevoluteJoint

from models import BASE_FRAME, LIO_URDF, TCP_FRAME

__all__ = ["BASE_FRAME", "JOINTS", "TCP_FRAME", "arm_joints", "arm_speeds", "make_arm_plant"]

JOINTS = tuple(f"lio_joint_{k}" for k in range(1, 7))
"""Of the arm, from the base on."""


def make_arm_plant(X_WB: RigidTransform | None = None) -> MultibodyPlant:
    """The shipped Lio with its base welded at `X_WB`, finalized, without a scene."""
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(str(LIO_URDF))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(BASE_FRAME), X_WB or RigidTransform())
    plant.Finalize()
    return plant


def arm_joints(plant: MultibodyPlant) -> list[RevoluteJoint]:
    """The arm's joints, from the base on."""
    return [plant.GetJointByName(name) for name in JOINTS]


def arm_speeds(plant: MultibodyPlant) -> np.ndarray:
    """Highest speed of each arm joint [rad/s]. Shape (6,)."""
    return np.array([joint.velocity_upper_limits().item() for joint in arm_joints(plant)])
