"""Peaks: forces of every step of the plant, joints beyond what they may, and the deepest overlap."""

import numpy as np
import pytest
from pydrake.common.value import Value
from pydrake.multibody.plant import ContactResults
from pydrake.systems.analysis import Simulator

from diagrams.station.lio_drive import ARM, MOVING
from diagrams.station.peaks import Peaks

PERIOD = 0.02


@pytest.fixture
def bench():
    peaks = Peaks(
        contact_pairs=2, stops=(np.full(ARM, -1.0), np.full(ARM, 2.0)), speeds=np.full(ARM, 4.0), period=PERIOD
    )
    return Bench(peaks)


class Bench:
    def __init__(self, peaks):
        self.peaks, self.simulator = peaks, Simulator(peaks)
        self.context = self.simulator.get_mutable_context()
        peaks.GetInputPort("contact_results").FixValue(self.context, Value(ContactResults()))
        self.set(contact_forces=[0.0, 0.0], penetration=[0.0], lio_state=self.state())

    def set(self, **values):
        for name, value in values.items():
            self.peaks.GetInputPort(name).FixValue(self.context, np.asarray(value, dtype=float))

    @staticmethod
    def state(joint=0, q=0.0, v=0.0):
        state = np.zeros(2 * MOVING)
        state[joint], state[MOVING + joint] = q, v
        return state

    def output(self, name):
        return self.peaks.GetOutputPort(name).Eval(self.context)


def test_joints(bench):
    bench.set(lio_state=bench.state(2, v=-3.0))
    bench.simulator.AdvanceTo(2 * PERIOD)
    np.testing.assert_allclose(bench.output("joint_peaks"), [0.75, 0])
    for k, state in enumerate((bench.state(1, q=-1.01), bench.state(5, q=2.01), bench.state(3, v=4.2))):
        bench.set(lio_state=state)
        bench.simulator.AdvanceTo((3 + k) * PERIOD)
    bench.set(lio_state=bench.state(3, q=1.99, v=1.0))
    bench.simulator.AdvanceTo(9 * PERIOD)
    np.testing.assert_allclose(bench.output("joint_peaks"), [1.05, 3])


def test_fingers_may_do_what_they_want(bench):
    state = np.zeros(2 * MOVING)
    state[[ARM, ARM + 1, MOVING + ARM, MOVING + ARM + 1]] = 50.0
    bench.set(lio_state=state)
    bench.simulator.AdvanceTo(2 * PERIOD)
    np.testing.assert_array_equal(bench.output("joint_peaks"), [0, 0])


def test_depth(bench):
    for k, depth in enumerate((0.001, 0.003, 0.002)):
        bench.set(penetration=[depth])
        bench.simulator.AdvanceTo((1 + k) * PERIOD)
    assert bench.output("peak_penetration")[0] == 0.003


def test_forces_where_something_touches(bench, monkeypatch):
    bench.set(contact_forces=[5.0, 5.0])
    bench.peaks.look(bench.context)
    np.testing.assert_array_equal(bench.output("peak_forces"), [0, 0])
    monkeypatch.setattr("diagrams.station.peaks.is_rigid_contact", lambda results: True)
    for forces in ((10.0, 60.0), (20.0, 0.0)):
        bench.set(contact_forces=forces)
        bench.peaks.look(bench.context)
    np.testing.assert_array_equal(bench.output("peak_forces"), [20, 60])
