"""The navigator as a system: default context, fixed inputs, evaluated outputs; its state is in the Context."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.navigation import Leg, NavigationOptions, NavigationState, disks_per_second, initial_state
from canal.navigation.joystick import JOYSTICK_PERIOD, in_step
from diagrams.navigator import CanalNavigator
from diagrams.scenario import Scenario
from diagrams.teleop.joystick_recording import JoystickRecording
from diagrams.teleop.joystick_selector import RecordedJoystick


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
    navigator.GetInputPort("alarm").FixValue(context, [200.0, 0.0, 200.0, 0.0])  # on the way to pick, along -y
    simulator.AdvanceTo(0.52)
    disk = state_of(simulator).disk
    simulator.AdvanceTo(1.0)
    assert state_of(simulator).disk == disk
    assert state_of(simulator).blocked


@pytest.mark.parametrize("rate", [17, 20, 23, 40, 50, 60, 100])
def test_the_stick_moves_the_point_equally_far_at_any_rate(canal, rate):
    # Pushes of one to five samples that begin anywhere in the control period, on a disk that does not saturate them.
    random = np.random.default_rng(7)
    rows = [(0.0, 0, 0, 0, 0, 1, 0), (0.05, 0, 0, 0, 0, 0, 0)]
    time, wanted, x, y = 1.5, np.zeros(3), *canal.axes(canal.home_disk)
    for samples in (1, 2, 1, 5, 3, 1):
        k_x, k_y = random.uniform(-0.3, 0.3, 2)
        rows += [(time, k_x, k_y, 0, 0, 0, 0), (time + 0.05 * samples, 0, 0, 0, 0, 0, 0)]
        wanted += 20 / 150 * 0.05 * samples * (k_x * x + k_y * y)
        time += 0.05 * (samples + random.integers(1, 5))
    table = np.array(rows + [(9.0, 0, 0, 0, 0, 0, 0)])
    builder = DiagramBuilder()
    navigator = CanalNavigator.AddToBuilder(builder=builder, canal=canal, period=in_step(1 / rate))
    recording = JoystickRecording(table[:, 0], table[:, 1:])
    source = RecordedJoystick.AddToBuilder(builder=builder, recording=recording)
    builder.Connect(source.GetOutputPort("joystick"), navigator.GetInputPort("joystick"))
    simulator = Simulator(builder.Build())
    context = navigator.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    navigator.GetInputPort("gripper_state").FixValue(context, [0.0, 0.0])
    simulator.AdvanceTo(4.001)  # at 4 s all rates tick
    state = navigator.state(context)
    assert Leg(int(state.leg)) is Leg.HOME_TO_PICK, "outwards the ratio is kept"
    moved = state.eta * canal.radius(state.disk) * np.array([np.cos(state.phi), np.sin(state.phi)])
    np.testing.assert_allclose(moved, [wanted @ x, wanted @ y], atol=1e-9)
    assert state.correction_time_s == pytest.approx(13 * 0.05, abs=1e-9)
    assert state.corrections == 6
    travelled = disks_per_second(canal, NavigationOptions()) * (4.0 - 0.05 * 13)
    assert canal.home_disk - state.disk == pytest.approx(travelled, abs=disks_per_second(canal, NavigationOptions()))


def test_events_of_all_default_rates_coincide_for_ever():
    scenario = Scenario()
    plant, tick = in_step(scenario.contact.time_step), in_step(1 / scenario.control_rate_hz)
    assert pytest.approx(0.05, abs=1e-12) == JOYSTICK_PERIOD
    assert round(tick / plant) == 4
    k = np.arange(1, 300_000)
    np.testing.assert_array_equal(3 * k * tick, k * JOYSTICK_PERIOD)
    np.testing.assert_array_equal(12 * k * plant, k * JOYSTICK_PERIOD)
    for rate in (20, 40, 50, 80, 100, 120, 200):
        np.testing.assert_array_equal(rate * k * in_step(1 / rate), 20 * k * JOYSTICK_PERIOD)


def test_a_period_that_keeps_no_step_stays_what_it_is():
    assert in_step(np.pi / 200) == np.pi / 200


def test_a_copied_context_goes_on_alike(simulator):
    simulator.AdvanceTo(0.5)
    navigator = simulator.get_system()
    other = Simulator(navigator, simulator.get_context().Clone())
    simulator.AdvanceTo(1.5)
    other.AdvanceTo(1.5)
    assert state_of(simulator) == state_of(other)
