"""The chain of joints between a base frame and a tool frame of any MultibodyPlant."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import BodyIndex, Frame, JacobianWrtVariable, Joint
from pydrake.systems.framework import Context

from canal.errors import InputError

_ORIGIN = np.zeros(3)


class ArmKinematics:
    """Poses and Jacobians of a tool frame T in a base frame B, as functions of the joints between them.

    Any MultibodyPlant will do: the joints are found by walking from the tool to the base, so other degrees of freedom
    (a gripper's, a second arm's) stay where the context has them: the plant's default one, unless one is given.

    Attributes:
        joint_names: names of the n joints, base first.
        q_min, q_max: joint limits [rad or m], shape (n,); infinite where the model has none.
        v_max: joint speed limits [rad/s or m/s], shape (n,).
    """

    def __init__(
        self, plant: MultibodyPlant, tool: Frame, base: Frame | None = None, context: Context | None = None
    ) -> None:
        self.plant, self.tool = plant, tool
        self.base = plant.world_frame() if base is None else base
        joints = _joints_between(plant, tool, self.base)
        self.joint_names = [joint.name() for joint in joints]
        self.context = plant.CreateDefaultContext() if context is None else context
        self._columns = np.array([joint.velocity_start() for joint in joints])
        self._positions = np.array([joint.position_start() for joint in joints])
        self._columns_used = _contiguous(self._columns)
        self._positions_used = _contiguous(self._positions)
        self._whole = plant.num_positions() == plant.num_velocities() == len(joints)
        self._full = plant.GetPositions(self.context)
        self.q_min = plant.GetPositionLowerLimits()[self._positions]
        self.q_max = plant.GetPositionUpperLimits()[self._positions]
        self.v_max = np.minimum(
            plant.GetVelocityUpperLimits()[self._columns], -plant.GetVelocityLowerLimits()[self._columns]
        )

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joint_names)

    @property
    def q_default(self) -> np.ndarray:
        """The joints' positions in the model's default context, shape (n,)."""
        return self.plant.GetPositions(self.plant.CreateDefaultContext())[self._positions]

    def set(self, q: np.ndarray) -> None:
        """Put the joints at q, shape (n,); it must be finite (Drake ends the process otherwise)."""
        if self._whole:  # q[i] is joint i: with no other joint, the tree's order is the chain's
            self.plant.SetPositions(self.context, q)
        else:
            self._full[self._positions_used] = q
            self.plant.SetPositions(self.context, self._full)

    def pose(self) -> np.ndarray:
        """X_BT at the posture that was set, as the 3x4 matrix [R | p]."""
        return self.plant.CalcRelativeTransform(self.context, self.base, self.tool).GetAsMatrix34()

    def jacobian(self) -> np.ndarray:
        """Spatial velocity of T in B by joint rate, expressed in B: rows ω then v, shape (6, n)."""
        jacobian = self.plant.CalcJacobianSpatialVelocity(
            self.context, JacobianWrtVariable.kQDot, self.tool, _ORIGIN, self.base, self.base
        )
        return jacobian[:, self._columns_used]

    def world_axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Joint rates' ω and velocity of the tool's origin, (3, n) each, and where that is, (3,), all in the world."""
        world = self.plant.world_frame()
        jacobian = self.plant.CalcJacobianSpatialVelocity(
            self.context, JacobianWrtVariable.kQDot, self.tool, _ORIGIN, world, world
        )[:, self._columns_used]
        return jacobian[:3], jacobian[3:], self.tool.CalcPoseInWorld(self.context).translation()


def _contiguous(indices: np.ndarray) -> slice | np.ndarray:
    """The indices as a slice where they are one: indexing by arrays costs ten times as much."""
    first, last = int(indices[0]), int(indices[-1])
    return slice(first, last + 1) if np.array_equal(indices, np.arange(first, last + 1)) else indices


def _joints_between(plant: MultibodyPlant, tool: Frame, base: Frame) -> list[Joint]:
    """The moving joints from base to tool, base first; each must have one degree of freedom."""
    parent_joint: dict[BodyIndex, Joint] = {}
    for index in plant.GetJointIndices():
        joint = plant.get_joint(index)
        parent_joint[joint.child_body().index()] = joint
    joints, body = [], tool.body()
    while body.index() != base.body().index():
        if body.index() not in parent_joint:
            raise InputError(
                f"frame '{tool.name()}' does not hang from frame '{base.name()}': "
                f"the chain ends at body '{body.name()}'; weld the robot's base to the base frame's body"
            )
        joint = parent_joint[body.index()]
        if joint.num_velocities() > 1:
            raise InputError(
                f"joint '{joint.name()}' has {joint.num_velocities()} degrees of freedom; "
                "inverse kinematics needs revolute or prismatic joints"
            )
        if joint.num_velocities() == 1:
            joints.append(joint)
        body = joint.parent_body()
    if not joints:
        raise InputError(f"no joint moves frame '{tool.name()}' against frame '{base.name()}'; name another frame")
    return joints[::-1]
