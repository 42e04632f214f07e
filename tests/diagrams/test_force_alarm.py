"""The alarm alone: from its limit on, until the force is clearly gone."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from diagrams.force_alarm import RELEASE, ForceAlarm


def test_it_lasts_from_the_limit_until_clearly_below_it():
    alarm = ForceAlarm(contact_pairs=2, limit_n=50.0, period=0.01)
    simulator = Simulator(alarm)
    context = simulator.get_mutable_context()
    alarm.GetInputPort("hand_force").FixValue(context, [1.0, 2.0, 3.0])
    time, told = 0.0, []
    for force in (0.0, 49.0, 51.0, 49.0, 50 * RELEASE - 0.1, 49.0, 60.0):
        alarm.GetInputPort("contact_forces").FixValue(context, [force, force / 2])
        told.append(alarm.GetOutputPort("alarm").Eval(context)[0])  # in the very tick
        time += 0.05
        simulator.AdvanceTo(time)
    assert told == [0, 0, 51, 49, 0, 0, 60]
    np.testing.assert_array_equal(alarm.GetOutputPort("alarm").Eval(context)[1:], [1, 2, 3])


@pytest.mark.parametrize("pairs", [0, 3])
def test_no_force_no_alarm(pairs):
    alarm = ForceAlarm(contact_pairs=pairs, limit_n=50.0, period=0.01)
    context = alarm.CreateDefaultContext()
    alarm.GetInputPort("hand_force").FixValue(context, np.zeros(3))
    alarm.GetInputPort("contact_forces").FixValue(context, np.zeros(pairs))
    assert not alarm.GetOutputPort("alarm").Eval(context).any()
