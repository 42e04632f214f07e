"""Grasps are friction: closed around an item, the pads carry it, and it slips less than 3 mm."""

import numpy as np
import pytest
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator

from diagrams.ik.solver import IkSolver
from diagrams.scenario import load_scenario
from diagrams.scene.world import Region, Robot
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant
from diagrams.station.lio_station import LioStation

# R_BT with x_T straight down; at azimuth 0 the fingers open along y_B.
DOWN = np.array([0.0, 0.7071067811865476, 0.0, -0.7071067811865476])
NEAR = np.array([-1.5, 0.3, 1.2, 0.0, 1.4, 0.0])
STEP = 0.01
AFTER = 1e-6
"""[s] A command comes just after its tick, as the IK's does."""
SLIP = 3e-3


def vector_to_pose(vector):
    return RigidTransform(Quaternion(vector[3:] / np.linalg.norm(vector[3:])), vector[:3])


def reach(solver, position, q):
    """Posture for the gripper to point down at a position in B, from a posture near by."""
    for _ in range(20):
        q = solver.solve(np.concatenate([position, DOWN]), 15.0, q, 1.0).q
    return q


@pytest.mark.parametrize("name", ["towel", "tshirt", "sock", "apple", "cup", "cube"])
def test_carried_without_slip(name):
    scenario = load_scenario("relocation" if name in ("apple", "cup", "cube") else "laundry")
    (item,) = (i for i in scenario.items if i.name == name)
    # One item on a bare table before the robot, its long side across the fingers.
    table = next(t for t in scenario.fixtures if t.name == "table")
    table.model, table.position, table.yaw_deg, scenario.robot = "laundry_table", [0.46, 0.0, 0.0], 0.0, Robot()
    scenario.fixtures, scenario.items = [table], [item]
    item.kind = "rigid"
    scenario.control_rate_hz = 1 / STEP
    item.start = Region(center=[0.45, 0.0, 0.30])

    solver = IkSolver(make_arm_plant(), TCP_FRAME, scenario.ik)
    low = reach(solver, np.array([0.45, 0.0, 0.335]), NEAR)
    high = reach(solver, np.array([0.42, 0.12, 0.50]), low)
    station = LioStation(scenario, q0=low)
    simulator = Simulator(station)
    context = simulator.get_mutable_context()
    wanted = station.GetInputPort("desired_state").FixValue(context, np.concatenate([low, np.zeros(6)]))
    station.GetInputPort("gripper_command").FixValue(context, [1.0])
    grips = station.GetOutputPort("grip_forces")
    assert grips.Eval(context) == [0], "the gripper is open about it"
    simulator.AdvanceTo(1.2 + AFTER)
    assert 10 < grips.Eval(context) < 200

    def seen_from_the_hand():
        X_BT = vector_to_pose(station.GetOutputPort("X_BT").Eval(context))
        return X_BT.inverse().multiply(vector_to_pose(station.GetOutputPort("item_poses").Eval(context)))

    held = seen_from_the_hand()
    turn = np.array([0.0, 0.0, 0.0, 0.0, -0.6, 0.5])  # the gripper tilts, as towards the door
    last = low
    slip = depth = 0.0
    for k in range(1, 151):
        share = 0.5 - 0.5 * np.cos(np.pi * k / 150)
        q = low + share * (high + turn - low)
        wanted.GetMutableData().set_value(np.concatenate([q, (q - last) / STEP]))
        last = q
        simulator.AdvanceTo(1.2 + k * STEP + AFTER)
        slip = max(slip, np.linalg.norm(seen_from_the_hand().translation() - held.translation()))
        depth = max(depth, station.GetOutputPort("penetration").Eval(context)[0])
    bounds = station.GetOutputPort("item_bounds").Eval(context)
    assert bounds[2] > 0.34  # it came along
    assert slip < SLIP
    assert depth < 5e-3
