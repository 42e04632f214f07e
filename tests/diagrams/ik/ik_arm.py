"""The Lio's arm and paths for it, shared by the tests of the inverse kinematics."""

from importlib.resources import files

import numpy as np
from pydrake.math import RotationMatrix
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from diagrams.ik.solver import IkSolver

TCP = "tcp"
# Where the arm stands at the start (docs/method.md, 6).
Q_START = np.array([-1.62113, -1.19688, 1.27447, 0.02532, 1.48154, -0.05674])


def lio_plant() -> MultibodyPlant:
    """The shipped robot on the floor, kinematics only."""
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(str(files("models") / "lio" / "lio.urdf"))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("lio_base"))
    plant.Finalize()
    return plant


def pose_of(solver: IkSolver, q: np.ndarray) -> np.ndarray:
    """Pose vector (7,) of the tool at posture q."""
    solver.kinematics.set(q)
    pose = solver.kinematics.pose()
    quaternion = RotationMatrix(pose[:, :3]).ToQuaternion().wxyz()
    return np.concatenate((pose[:, 3], quaternion))
