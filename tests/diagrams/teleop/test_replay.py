"""A log's samples of the joystick replay the travel bit for bit at any control rate, pauses and stops included."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from canal.demonstration import Demonstration
from canal.files import write_npz
from canal.learning import learn_canal
from canal.navigation import FIELD_NAMES
from canal.navigation.joystick import JOYSTICK_PERIOD, in_step
from diagrams.navigator import CanalNavigator
from diagrams.run_log import RunLog
from diagrams.teleop.joystick_recording import JoystickRecording, load_recording
from diagrams.teleop.joystick_selector import JoystickSelector, RecordedJoystick


@pytest.fixture(scope="module")
def canal():
    t = np.linspace(0, 1, 100)
    sides = [np.column_stack([0.4 + side + 0 * t, t - 0.5, 0.6 + 0 * t]) for side in (-0.05, 0.05)]
    return learn_canal([Demonstration(p, np.tile([1.0, 0, 0, 0], (100, 1)), None, str(p[0])) for p in sides])


def travel(canal, recording, rate, duration):
    builder = DiagramBuilder()
    period = in_step(1 / rate)
    source = RecordedJoystick.AddToBuilder(builder=builder, recording=recording)
    selector = JoystickSelector.AddToBuilder(
        builder=builder,
        simulated=source.GetOutputPort("joystick"),
        simulated_person_in_charge=source.GetOutputPort("person_in_charge"),
    )
    navigator = CanalNavigator.AddToBuilder(builder=builder, canal=canal, period=period)
    builder.Connect(selector.GetOutputPort("joystick"), navigator.GetInputPort("joystick"))
    log = RunLog(
        builder,
        {"navigation_state": navigator.GetOutputPort("navigation_state")},
        period,
        samples={
            "joystick_samples": selector.GetOutputPort("joystick"),
            "in_charge_samples": selector.GetOutputPort("person_in_charge"),
        },
    )
    simulator = Simulator(builder.Build())
    root = simulator.get_mutable_context()
    navigator.GetInputPort("gripper_state").FixValue(navigator.GetMyMutableContextFromRoot(root), [0.0, 0.0])
    simulator.AdvanceTo(duration)
    return log.signals(root)


@pytest.mark.parametrize("rate", [17, 20, 23, 33, 50, 60])
@pytest.mark.parametrize("duration", [6.0, 6.02])
def test_at_any_control_rate(canal, tmp_path, rate, duration):
    random = np.random.default_rng(rate)
    n = round(duration / JOYSTICK_PERIOD)
    joystick = np.hstack([random.uniform(-0.7, 0.7, (n, 2)), random.random((n, 4)) < (0.1, 0.1, 0.1, 0.05)])
    joystick[random.random(n) < 0.6, :2] = 0
    person = (np.arange(n) > n // 2).astype(float)
    first = travel(
        canal, JoystickRecording(np.arange(n) * JOYSTICK_PERIOD, joystick, person_in_charge=person), rate, duration
    )
    for field in ("running", "paused", "corrections", "backtracks"):
        assert np.ptp(first["navigation_state"][:, FIELD_NAMES.index(field)]) > 0, field
    write_npz(
        tmp_path / "log.npz",
        joystick_time=first["sample_time"],
        joystick=first["joystick_samples"],
        joystick_in_charge=first["in_charge_samples"][:, 0],
    )
    again = travel(canal, load_recording(tmp_path / "log.npz"), rate, duration)
    for name in first:
        np.testing.assert_array_equal(first[name], again[name], err_msg=name)
