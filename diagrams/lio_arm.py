"""The Lio alone, for kinematics: what the inverse kinematics computes with."""

from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from models import LIO_URDF

TCP_FRAME = "tcp"
BASE_FRAME = "lio_base"


def make_arm_plant(X_WB: RigidTransform | None = None) -> MultibodyPlant:
    """The shipped Lio with its base welded at `X_WB`, finalized, without a scene."""
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(str(LIO_URDF))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(BASE_FRAME), X_WB or RigidTransform())
    plant.Finalize()
    return plant
