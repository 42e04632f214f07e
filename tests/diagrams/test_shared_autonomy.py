"""The whole diagram: its state is in the Context, a blow stops it, and it can be copied and built twice."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.navigation import NavigationState
from diagrams.scenario import load_scenario, with_items
from diagrams.shared_autonomy import build_shared_autonomy
from models import MODELS


@pytest.fixture(scope="module")
def canal():
    return learn_canal([load_demonstration(MODELS / "demonstrations" / f"laundry_{i}.npz") for i in (1, 2)])


def build(canal, **kwargs):
    scenario = with_items(load_scenario("laundry"), "rigid")
    if "force_limit_n" in kwargs:
        scenario.monitor.force_limit_n = kwargs.pop("force_limit_n")
    return build_shared_autonomy(scenario=scenario, canal=canal, **kwargs)


def joints(system, root) -> np.ndarray:
    return system.station.GetOutputPort("q").Eval(system.station.GetMyContextFromRoot(root)).copy()


def navigation(system, root) -> NavigationState:
    port = system.navigator.GetOutputPort("navigation_state")
    return NavigationState.from_vector(port.Eval(system.navigator.GetMyContextFromRoot(root)))


def test_a_copied_run_goes_on_alike(canal):
    system = build(canal)
    simulator = Simulator(system.diagram)
    system.take_first_measurements(simulator.get_mutable_context())
    simulator.AdvanceTo(1.5)
    copy = Simulator(system.diagram, simulator.get_context().Clone())
    simulator.AdvanceTo(2.5)
    copy.AdvanceTo(2.5)
    np.testing.assert_array_equal(joints(system, simulator.get_context()), joints(system, copy.get_context()))
    assert navigation(system, simulator.get_context()) == navigation(system, copy.get_context())


def test_two_in_one_process_do_not_know_of_each_other(canal):
    first, second = build(canal), build(canal)
    ends = []
    for system in (first, second):
        simulator = Simulator(system.diagram)
        system.take_first_measurements(simulator.get_mutable_context())
        simulator.AdvanceTo(1.0)
        ends.append(joints(system, simulator.get_context()))
    np.testing.assert_array_equal(*ends)


def test_starts_on_the_canal_and_follows_it(canal):
    system = build(canal)
    simulator = Simulator(system.diagram)
    root = simulator.get_mutable_context()
    system.take_first_measurements(root)
    worst = 0.0
    for k in range(1, 41):
        simulator.AdvanceTo(0.1 * k)
        wanted = system.navigator.GetOutputPort("X_BT_desired").Eval(system.navigator.GetMyContextFromRoot(root))
        actual = system.station.GetOutputPort("X_BT").Eval(system.station.GetMyContextFromRoot(root))
        worst = max(worst, float(np.linalg.norm(wanted[:3] - actual[:3])))
    assert navigation(system, root).running
    assert worst < 0.01


def test_a_blow_stops_the_motion_while_it_lasts(canal):
    # The station's measured forces are replaced by a blow of 500 N for a moment; all the rest is real.
    system = build(canal, force_limit_n=140.0)
    simulator = Simulator(system.diagram)
    root = simulator.get_mutable_context()
    system.take_first_measurements(root)
    simulator.AdvanceTo(1.5)
    assert navigation(system, root).running
    hold = next(h for h in system.holds if h.get_name() == "measured_contact_forces")
    blow = np.zeros(len(system.station.contact_pairs))
    blow[0] = 500.0
    hold.SetVectorState(hold.GetMyMutableContextFromRoot(root), blow)
    simulator.AdvanceTo(1.52)
    stopped = navigation(system, root)
    assert stopped.blocked
    simulator.AdvanceTo(3.0)
    freed = navigation(system, root)
    assert not freed.alarm
    assert not freed.blocked
    assert freed.running
