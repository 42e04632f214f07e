"""The recorded joystick and the switch between a person and the simulated operator."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource, LogVectorOutput

from canal.navigation.joystick import JOYSTICK_PERIOD, clean_joystick, in_step
from diagrams.teleop.joystick_recording import JoystickRecording
from diagrams.teleop.joystick_selector import JoystickSelector, RecordedJoystick
from diagrams.teleop.live_joystick import LiveSample

ANYTHING = st.lists(st.floats(allow_nan=True, allow_infinity=True), min_size=6, max_size=6)
SIMULATED = np.array([0.25, 0.5, 0, 0, 1, 0])


def run(recording: JoystickRecording, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and joystick vectors at 100 Hz, as a run's log has them."""
    builder = DiagramBuilder()
    source = RecordedJoystick.AddToBuilder(builder=builder, recording=recording)
    sink = LogVectorOutput(source.GetOutputPort("joystick"), builder, in_step(0.01))
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(duration)
    log = sink.FindLog(simulator.get_context())
    return log.sample_times(), log.data().T


@given(ANYTHING)
def test_clean_is_within_bounds_and_cleaning_twice_changes_nothing(values):
    clean = clean_joystick(np.array(values))
    assert np.isfinite(clean).all()
    assert np.hypot(*clean[:2]) <= 1 + 1e-9
    assert set(clean[2:]) <= {0.0, 1.0}
    np.testing.assert_array_equal(clean_joystick(clean), clean)


def test_the_stick_keeps_its_direction_when_it_is_cut_to_the_disc():
    np.testing.assert_allclose(clean_joystick(np.array([1, 1, 0, 0, 0, 0]))[:2], [np.sqrt(0.5)] * 2)
    np.testing.assert_allclose(clean_joystick(np.array([0.3, -0.2, 0, 0, 0, 0]))[:2], [0.3, -0.2])


@given(ANYTHING)
def test_a_live_device_hands_on_a_clean_joystick_whatever_it_reads(values):
    np.testing.assert_array_equal(LiveSample(np.array(values), True).joystick, clean_joystick(np.array(values)))


def test_a_recording_hands_on_a_stick_within_the_unit_disc():
    diagonal = JoystickRecording(np.array([0.0, 1.0]), np.array([[1.0, 1.0, 0, 0, 0, 0], np.zeros(6)]))
    np.testing.assert_allclose(diagonal.at(0.5), [np.sqrt(0.5), np.sqrt(0.5), 0, 0, 0, 0])


def test_a_recording_is_sampled_at_20_hz():
    rows = np.array([[0, 1, 0], [0.33, 0, 0.5], [0.61, 0, 0], [2, 0, 0]])
    time, joystick = run(JoystickRecording(rows[:, 0], np.pad(rows[:, 1:], ((0, 0), (0, 4)))), 1.0)
    changes = time[1:][np.any(np.diff(joystick, axis=0) != 0, axis=1)]
    # What is logged at a sample's own time is what held before it. 0.33 belongs to the sample at 0.35, 0.61 to 0.60.
    np.testing.assert_allclose(changes, [0.01, 0.36, 0.61])
    np.testing.assert_array_equal(joystick[time > 0.02][0, :2], [1, 0])
    np.testing.assert_array_equal(joystick[-1], np.zeros(6))


def test_the_log_of_a_run_replays_bit_for_bit():
    random = np.random.default_rng(4)
    stick = random.uniform(-0.7, 0.7, (60, 2))
    buttons = random.integers(0, 2, (60, 4))
    first = run(JoystickRecording(np.sort(random.uniform(0, 3, 60)), np.hstack([stick, buttons])), 3.0)
    second = run(JoystickRecording(*first), 2.9)
    assert np.any(first[1])
    n = len(second[0])
    np.testing.assert_array_equal(second[0], first[0][:n])
    np.testing.assert_array_equal(second[1], first[1][:n])


def test_a_recording_tells_who_held_the_joystick():
    time = np.array([0.0, 1.0, 2.0])
    source = RecordedJoystick(JoystickRecording(time, np.zeros((3, 6)), person_in_charge=np.array([0.0, 1.0, 1.0])))
    simulator = Simulator(source)
    for until, person in ((0.5, 0), (1.5, 1), (9.0, 1)):
        simulator.AdvanceTo(until)
        assert source.GetOutputPort("person_in_charge").Eval(simulator.get_context()) == person
    stranger = RecordedJoystick(JoystickRecording(time, np.zeros((3, 6))))
    assert stranger.GetOutputPort("person_in_charge").Eval(stranger.CreateDefaultContext()) == 1


def test_the_selector_passes_on_who_held_a_recorded_joystick():
    for recorded in (0.0, 1.0):
        selector, context = selector_context(np.zeros(6), SIMULATED)
        selector.GetInputPort("simulated_person_in_charge").FixValue(context, [recorded])
        assert selector.GetOutputPort("person_in_charge").Eval(context) == recorded
        np.testing.assert_array_equal(selector.GetOutputPort("joystick").Eval(context), SIMULATED)


def selector_context(person=None, simulated=None):
    selector = JoystickSelector()
    context = selector.CreateDefaultContext()
    for name, value in (("person", person), ("simulated", simulated)):
        if value is not None:
            selector.GetInputPort(name).FixValue(context, value)
    return selector, context


def test_untouched_the_simulated_operator_drives():
    selector, context = selector_context(np.zeros(6), SIMULATED)
    np.testing.assert_array_equal(selector.GetOutputPort("joystick").Eval(context), SIMULATED)
    assert selector.GetOutputPort("person_in_charge").Eval(context) == 0


def test_ports_left_open():
    selector, context = selector_context()
    np.testing.assert_array_equal(selector.GetOutputPort("joystick").Eval(context), np.zeros(6))
    selector, context = selector_context(simulated=SIMULATED)
    np.testing.assert_array_equal(selector.GetOutputPort("joystick").Eval(context), SIMULATED)


def test_one_touch_takes_over_at_once_and_for_good():
    # A person touches one button during a single sample, at 0.5 s.
    time = np.array([0.0, 0.5, 0.5 + JOYSTICK_PERIOD, 2.0])
    joystick = np.zeros((4, 6))
    joystick[1, 3] = 1
    builder = DiagramBuilder()
    person = RecordedJoystick.AddToBuilder(builder=builder, recording=JoystickRecording(time, joystick))
    simulated = builder.AddSystem(ConstantVectorSource(SIMULATED))
    selector = JoystickSelector.AddToBuilder(
        builder=builder, person=person.GetOutputPort("joystick"), simulated=simulated.get_output_port()
    )
    out = LogVectorOutput(selector.GetOutputPort("joystick"), builder, in_step(0.01))
    charge = LogVectorOutput(selector.GetOutputPort("person_in_charge"), builder, in_step(0.01))
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(1.0)
    log = out.FindLog(simulator.get_context())
    before = log.sample_times() < 0.505
    during = ~before & (log.sample_times() < 0.555)
    assert (log.data().T[before] == SIMULATED).all()
    assert (log.data().T[during] == [0, 0, 0, 1, 0, 0]).all()
    assert (log.data().T[~before & ~during] == 0).all()
    np.testing.assert_array_equal(charge.FindLog(simulator.get_context()).data()[0], ~before)
