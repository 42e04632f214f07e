"""The chain of joints: found in any plant, and followed by the solver whatever its joints."""

import numpy as np
import pytest
from ik_arm import TCP, lio_plant, pose_of
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from canal.errors import InputError
from diagrams.ik.kinematics import ArmKinematics
from diagrams.ik.solver import IkSolver

DT = 0.01


def test_the_chain_leaves_the_fingers_out() -> None:
    plant = lio_plant()
    arm = ArmKinematics(plant, plant.GetFrameByName(TCP))
    assert arm.joint_names == [f"lio_joint_{i}" for i in range(1, 7)]
    assert plant.num_positions() == 8
    np.testing.assert_allclose(arm.v_max, np.radians(95.0), rtol=1e-4)


def test_jacobian_is_the_slope_of_the_pose() -> None:
    plant = lio_plant()
    arm = ArmKinematics(plant, plant.GetFrameByName(TCP))
    q = np.array([0.3, -0.5, 0.7, 0.2, 0.9, -0.4])
    arm.set(q)
    R, jacobian = arm.pose()[:, :3], arm.jacobian()
    omega, v, p = arm.world_axes()
    np.testing.assert_allclose(np.vstack((omega, v)), jacobian, atol=1e-12)
    np.testing.assert_allclose(p, arm.pose()[:, 3], atol=1e-12)
    for i, step in enumerate(1e-6 * np.eye(6)):
        arm.set(q + step)
        ahead = arm.pose()
        arm.set(q - step)
        change = (ahead - arm.pose()) / 2e-6
        turn = change[:, :3] @ R.T
        np.testing.assert_allclose(jacobian[:3, i], [turn[2, 1], turn[0, 2], turn[1, 0]], atol=1e-8)
        np.testing.assert_allclose(jacobian[3:, i], change[:, 3], atol=1e-8)


def test_a_frame_that_no_joint_moves_is_refused() -> None:
    plant = lio_plant()
    with pytest.raises(InputError, match="no joint moves"):
        IkSolver(plant, "lio_base")


SEVEN_JOINTS = "".join(
    f'<link name="l{i + 1}"><inertial><mass value="1"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    f'<joint name="j{i + 1}" type="{"prismatic" if i == 0 else "revolute"}"><parent link="l{i}"/>'
    f'<child link="l{i + 1}"/><origin xyz="0 0 0.15"/><axis xyz="{"1 0 0" if i == 0 else ("0 0 1", "0 1 0")[i % 2]}"/>'
    '<limit lower="-1.5" upper="1.5" velocity="2" effort="10"/></joint>'
    for i in range(7)
)


def test_another_robot_with_seven_joints_one_of_them_sliding_is_welcome() -> None:
    plant = MultibodyPlant(0.0)
    urdf = f'<robot name="other"><link name="l0"/>{SEVEN_JOINTS}</robot>'
    Parser(plant).AddModelsFromString(urdf, "urdf")
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("l0"))
    plant.Finalize()
    solver = IkSolver(plant, "l7", base_frame="l0")
    assert solver.n == 7
    q = np.array([0.1, 0.2, -0.5, 0.3, 0.8, -0.2, 0.4])
    target = pose_of(solver, q + 0.3)
    for _ in range(60):
        result = solver.solve(target, 15.0, q, DT)
        assert np.all(np.abs(result.q - q) <= solver.v_max * DT + 1e-12)
        q = result.q
    assert result.position_error < 1e-6
    assert result.orientation_error < 1e-6
