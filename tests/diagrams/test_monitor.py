"""The monitor alone: what it measures, how a run ends."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator, SimulatorStatus

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.navigation import initial_state
from diagrams.geometry.goals import MarkGoal
from diagrams.monitor import Monitor, MonitorOptions

MARK = np.array([0.4, 0.5, 0.5])


@pytest.fixture(scope="module")
def canal():
    t = np.linspace(0, 1, 100)
    orientation = np.tile([1.0, 0, 0, 0], (100, 1))
    sides = [np.column_stack([0.4 + side + 0 * t, t - 0.5, 0.6 + 0 * t]) for side in (-0.05, 0.05)]
    return learn_canal([Demonstration(p, orientation, None, str(i)) for i, p in enumerate(sides)])


class Bench:
    """A monitor with every input fixed, to be changed one at a time."""

    def __init__(self, canal, **options):
        self.monitor = Monitor(canal=canal, goals=[MarkGoal(MARK)], options=MonitorOptions(**options))
        self.simulator = Simulator(self.monitor)
        self.context = self.simulator.get_mutable_context()
        self.state = initial_state(canal)
        away = MARK + [0.5, 0, 0]
        self.set(
            item_poses=[*away, 1, 0, 0, 0],
            item_bounds=[*(away - 0.03), *(away + 0.03)],
            item_speeds=[0.0],
            grip_forces=[0.0],
        )
        self.navigate(running=1.0)

    def set(self, **values):
        for name, value in values.items():
            self.monitor.GetInputPort(name).FixValue(self.context, np.asarray(value, dtype=float))

    def navigate(self, **changes):
        from dataclasses import replace

        self.state = replace(self.state, **changes)
        self.set(navigation_state=self.state.to_vector())

    def put_on_mark(self):
        self.set(item_poses=[*MARK, 1, 0, 0, 0], item_bounds=[*(MARK - 0.03), *(MARK + 0.03)])

    def run(self, until) -> SimulatorStatus:
        return self.simulator.AdvanceTo(until)

    def output(self, name):
        return self.monitor.GetOutputPort(name).Eval(self.context)


def ended(status: SimulatorStatus) -> bool:
    return status.reason() == SimulatorStatus.ReturnReason.kReachedTerminationCondition


@pytest.fixture
def bench(canal):
    return Bench(canal)


def test_ends_when_all_is_placed_and_says_when(bench):
    assert not ended(bench.run(0.2))
    bench.put_on_mark()
    status = bench.run(1.0)
    assert ended(status)
    assert "placed" in status.message()
    assert 0.2 <= bench.output("placed_times")[0] <= 0.3


@pytest.mark.parametrize("spoil", ["held", "moving", "at the goal"])
def test_not_placed_while(bench, canal, spoil):
    bench.put_on_mark()
    if spoil == "held":
        bench.set(grip_forces=[0.1])
    elif spoil == "moving":
        bench.set(item_speeds=[0.3])
    else:
        bench.navigate(disk=canal.n_disks - 1.0)  # placed, but the robot is still among the items
    assert not ended(bench.run(0.5))
    assert (bench.output("placed_times")[0] >= 0) == (spoil == "at the goal")


def test_what_falls_off_its_mark_is_not_placed(bench, canal):
    bench.navigate(disk=canal.n_disks - 1.0)
    bench.put_on_mark()
    bench.run(0.3)
    bench.set(item_poses=[*(MARK - [0, 0, 0.4]), 1, 0, 0, 0])
    bench.run(0.6)
    assert bench.output("placed_times")[0] < 0


def test_a_stop_ends_the_run_unless_a_person_is_in_charge(canal):
    for person, ends in ((0.0, True), (1.0, False)):
        bench = Bench(canal)
        bench.set(person_in_charge=[person])
        bench.run(0.2)
        bench.navigate(running=0.0)
        status = bench.run(0.5)
        assert ended(status) is ends
        if ends:
            assert "0 of 1 placed" in status.message()


def test_a_closed_gripper_holds_what_it_touches_and_nothing_else(bench, canal):
    # It rests at the look after 0.2 s with the closed gripper right above it.
    bench.navigate(gripper_closed=1.0, disk=canal.n_disks - 1.0)
    bench.run(0.2)
    bench.put_on_mark()
    bench.run(1.0)
    assert bench.output("placed_times")[0] == pytest.approx(0.25)


def test_a_finger_that_comes_back_without_moving_it_changes_no_time(bench, canal):
    bench.navigate(disk=canal.n_disks - 1.0)
    bench.put_on_mark()
    bench.set(grip_forces=[2.0])
    bench.run(0.3)
    assert bench.output("placed_times")[0] < 0, "it is still held"
    bench.set(grip_forces=[0.0])
    bench.run(0.62)
    free = bench.output("placed_times")[0]
    assert 0.3 <= free <= 0.36
    bench.set(grip_forces=[2.0])
    bench.run(0.8)
    assert bench.output("placed_times")[0] < 0
    bench.set(grip_forces=[0.0])
    bench.run(1.0)
    assert bench.output("placed_times")[0] == free
