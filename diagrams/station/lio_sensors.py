"""What is measured on the Lio: joints, gripper, and where the tool is."""

from __future__ import annotations

from pydrake.common.value import AbstractValue
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from diagrams.geometry.pose_vector import pose_to_vector
from diagrams.station.lio_drive import ARM
from models import TCP_FRAME

JOINTS = ARM + 2
"""Positions of the model: six of the arm, two fingers of which the second mirrors the first."""


class LioSensor(LeafSystem):
    """Sorts the measured state.

    ```
     lio_state (16: q, v) → ┌───────────┐ → q (6) [rad]
                            │ LioSensor │ → v (6) [rad/s]
                            │           │ → gripper_state (2: angle [rad], rate [rad/s])
       body_poses         → └───────────┘ → X_BT (7: position [m], quaternion w x y z)
    ```
    """

    def __init__(self, plant: MultibodyPlant, lio: ModelInstanceIndex, X_WB: RigidTransform) -> None:
        """Read the model `lio` of a finalized plant, whose base stands at `X_WB`."""
        super().__init__()
        self._tcp = int(plant.GetBodyByName(TCP_FRAME, lio).index())
        self._X_BW = X_WB.inverse()
        self._lio = self.DeclareVectorInputPort("lio_state", 2 * JOINTS)
        self._poses = self.DeclareAbstractInputPort("body_poses", AbstractValue.Make([RigidTransform()]))
        state, poses = {self._lio.ticket()}, {self._poses.ticket()}
        self.DeclareVectorOutputPort("q", ARM, self._calc_q, state)
        self.DeclareVectorOutputPort("v", ARM, self._calc_v, state)
        self.DeclareVectorOutputPort("gripper_state", 2, self._calc_gripper, state)
        self.DeclareVectorOutputPort("X_BT", 7, self._calc_tcp, poses)

    def _calc_q(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._lio.Eval(context)[:ARM])

    def _calc_v(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._lio.Eval(context)[JOINTS : JOINTS + ARM])

    def _calc_gripper(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._lio.Eval(context)[[ARM, JOINTS + ARM]])

    def _calc_tcp(self, context: Context, output: BasicVector) -> None:
        X_WT = self._poses.Eval(context)[self._tcp]
        output.SetFromVector(pose_to_vector(self._X_BW.multiply(X_WT)))
