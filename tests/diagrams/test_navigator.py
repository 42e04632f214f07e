"""The navigator as a system: default context, fixed inputs, evaluated outputs; its state is in the Context."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.navigation import NavigationState, disks_per_second, initial_state
from diagrams.navigator import CanalNavigator


@pytest.fixture(scope="module")
def canal():
    t = np.linspace(0, 1, 100)
    orientation = np.column_stack([np.cos(t), np.sin(t), 0 * t, 0 * t])
    sides = [np.column_stack([0.4 + side + 0 * t, t - 0.5, 0.6 + 0 * t]) for side in (-0.05, 0.05)]
    return learn_canal([Demonstration(p, orientation, None, str(i)) for i, p in enumerate(sides)])


@pytest.fixture
def simulator(canal):
    navigator = CanalNavigator(canal)
    simulator = Simulator(navigator)
    context = simulator.get_mutable_context()
    navigator.GetInputPort("gripper_state").FixValue(context, [0.0, 0.0])
    navigator.GetInputPort("joystick").FixValue(context, [0, 0, 0, 0, 1, 0])
    return simulator


def state_of(simulator) -> NavigationState:
    system, context = simulator.get_system(), simulator.get_context()
    return NavigationState.from_vector(system.GetOutputPort("navigation_state").Eval(context))


def test_starts_at_home(canal):
    navigator = CanalNavigator(canal)
    context = navigator.CreateDefaultContext()
    pose = navigator.GetOutputPort("X_BT_desired").Eval(context)
    np.testing.assert_allclose(pose[:3], canal.directrix[canal.home_disk])
    np.testing.assert_allclose(pose[3:], canal.orientations[canal.home_disk])
    assert navigator.GetOutputPort("gripper_command").Eval(context)[0] == 0
    assert navigator.GetOutputPort("orientation_weight").Eval(context)[0] == canal.weight(canal.home_disk)
    assert navigator.state(context) == initial_state(canal)


def test_travels_at_the_demonstrations_speed(canal, simulator):
    simulator.Initialize()
    simulator.AdvanceTo(1.0)
    travelled = canal.home_disk - state_of(simulator).disk
    assert travelled == pytest.approx(disks_per_second(canal, simulator.get_system()._options) * 1.0, rel=0.02)


def test_stick_moves_the_point(canal, simulator):
    navigator, context = simulator.get_system(), simulator.get_mutable_context()
    simulator.AdvanceTo(0.5)
    before = navigator.GetOutputPort("X_BT_desired").Eval(context)[:3].copy()
    x, _ = canal.axes(state_of(simulator).disk)
    navigator.GetInputPort("joystick").FixValue(context, [1, 0, 0, 0, 0, 0])
    simulator.AdvanceTo(0.6)
    moved = navigator.GetOutputPort("X_BT_desired").Eval(context)[:3] - before
    assert moved @ x == pytest.approx(np.linalg.norm(moved), rel=0.05)
    assert np.linalg.norm(moved) == pytest.approx(0.1 * 20 / 150, rel=0.15)


def test_alarm_stops(simulator):
    navigator, context = simulator.get_system(), simulator.get_mutable_context()
    simulator.AdvanceTo(0.5)
    navigator.GetInputPort("alarm").FixValue(context, [1.0])
    simulator.AdvanceTo(0.52)
    disk = state_of(simulator).disk
    simulator.AdvanceTo(1.0)
    assert state_of(simulator).disk == disk
    assert state_of(simulator).blocked


def test_a_copied_context_goes_on_alike(simulator):
    simulator.AdvanceTo(0.5)
    navigator = simulator.get_system()
    other = Simulator(navigator, simulator.get_context().Clone())
    simulator.AdvanceTo(1.5)
    other.AdvanceTo(1.5)
    assert state_of(simulator) == state_of(other)
