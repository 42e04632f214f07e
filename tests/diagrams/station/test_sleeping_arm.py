"""The arm stands still for as long as one likes: nothing in it or in the contact solver gives way."""

import numpy as np
import pytest
from ik_arm import Q_START, TCP, lio_plant, pose_of
from pydrake.systems.analysis import Simulator

from diagrams.ik.solver import IkSolver
from diagrams.ik.system import IkStatusField, OrientationWeightedIk
from diagrams.scenario import load_scenario
from diagrams.station.lio_drive import OPEN_ANGLE
from diagrams.station.lio_station import START_POSTURE, LioStation

STOP = 2.9670597283903604
"""[rad] of joints 4 and 6."""


@pytest.mark.parametrize("dither", [0.0, 1e-9, 1e-10, 1e-12, 1e-14])
@pytest.mark.parametrize("at_stops", [False, True])
def test_the_contact_solver_converges_where_nothing_but_a_dithering_arm_moves(dither, at_stops):
    """Everything else locked, nothing carries momentum: a drive that aimed at a joint's stop ended the run then."""
    q0 = START_POSTURE.copy()
    if at_stops:
        q0[[3, 5]] = -STOP, STOP
    station = LioStation(load_scenario("relocation"), q0=q0)
    simulator = Simulator(station)
    context = simulator.get_mutable_context()
    wanted = station.GetInputPort("desired_state").FixValue(context, np.concatenate([q0, np.zeros(6)]))
    station.GetInputPort("gripper_command").FixValue(context, [0.0])
    for item in station.scene.rigid_items:
        item.body.Lock(station.plant.GetMyMutableContextFromRoot(context))
    rng = np.random.default_rng(0)
    for tick in range(1, 101):
        wanted.GetMutableData().set_value(np.concatenate([q0, np.zeros(6)]) + dither * rng.normal(size=12))
        simulator.AdvanceTo(0.02 * tick)
    assert station.GetOutputPort("q").Eval(context) == pytest.approx(q0, abs=2e-4)
    assert station.GetOutputPort("gripper_state").Eval(context)[0] == pytest.approx(OPEN_ANGLE, abs=2e-4)


def test_a_posture_that_is_the_best_is_held_exactly():
    """The solver's answers go on moving by 1e-10 rad and less; the command does not."""
    solver = IkSolver(lio_plant(), TCP)
    system = OrientationWeightedIk(solver, q_start=Q_START, period=0.02)
    context = system.CreateDefaultContext()
    system.GetInputPort("X_BT_desired").FixValue(context, pose_of(solver, Q_START + 0.05))
    system.GetInputPort("orientation_weight").FixValue(context, [15.0])
    command = system.GetOutputPort("desired_state")
    for _ in range(100):
        context.SetDiscreteState(system.EvalUniquePeriodicDiscreteUpdate(context))
    before = command.Eval(context).copy()
    assert pose_of(solver, before[:6]) == pytest.approx(pose_of(solver, Q_START + 0.05), abs=1e-5)
    for _ in range(100):
        context.SetDiscreteState(system.EvalUniquePeriodicDiscreteUpdate(context))
    np.testing.assert_array_equal(command.Eval(context), before)
    np.testing.assert_array_equal(before[6:], np.zeros(6))
    assert system.GetOutputPort("ik_status").Eval(context)[IkStatusField.SOLVE_TIME] == 0.0, "nothing to solve"
    system.GetInputPort("orientation_weight").FixValue(context, [1.0])
    context.SetDiscreteState(system.EvalUniquePeriodicDiscreteUpdate(context))
    assert system.GetOutputPort("ik_status").Eval(context)[IkStatusField.SOLVE_TIME] > 0.0, "another question"
