"""The inverse kinematics as a system: alone, then in a diagram."""

import numpy as np
import pytest
from ik_arm import Q_START, TCP, lio_plant, pose_of
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from canal.errors import InputError
from diagrams.ik.options import IkStatus
from diagrams.ik.solver import IkSolver
from diagrams.ik.system import CONTROL_PERIOD, IkStatusField, OrientationWeightedIk


@pytest.fixture(scope="module")
def solver() -> IkSolver:
    return IkSolver(lio_plant(), TCP)


def test_alone_one_update_steps_towards_the_target(solver: IkSolver) -> None:
    system = OrientationWeightedIk(solver, q_start=Q_START)
    context = system.CreateDefaultContext()
    target = pose_of(solver, Q_START + 0.005)
    system.GetInputPort("X_BT_desired").FixValue(context, target)
    system.GetInputPort("orientation_weight").FixValue(context, [15.0])
    command = system.GetOutputPort("desired_state")
    np.testing.assert_array_equal(command.Eval(context), np.concatenate((Q_START, np.zeros(6))))
    context.SetDiscreteState(system.EvalUniquePeriodicDiscreteUpdate(context))
    q, v = np.split(command.Eval(context), 2)
    np.testing.assert_allclose(q, Q_START + 0.005, atol=2e-4)
    np.testing.assert_allclose(v, (q - Q_START) / CONTROL_PERIOD, atol=1e-12)
    status = system.GetOutputPort("ik_status").Eval(context)
    assert status[IkStatusField.STATUS] == IkStatus.CONVERGED
    assert status[IkStatusField.SOLVE_TIME] > 0.0
    assert status[IkStatusField.BOUND_VIOLATION] == 0.0


def test_target_that_is_not_finite_holds_and_says_so(solver: IkSolver) -> None:
    system = OrientationWeightedIk(solver, q_start=Q_START)
    context = system.CreateDefaultContext()
    system.GetInputPort("X_BT_desired").FixValue(context, np.full(7, np.nan))
    system.GetInputPort("orientation_weight").FixValue(context, [15.0])
    context.SetDiscreteState(system.EvalUniquePeriodicDiscreteUpdate(context))
    np.testing.assert_array_equal(
        system.GetOutputPort("desired_state").Eval(context), np.concatenate((Q_START, np.zeros(6)))
    )
    assert system.GetOutputPort("ik_status").Eval(context)[IkStatusField.STATUS] == IkStatus.HELD


def test_in_a_diagram_it_arrives_at_the_target_at_the_allowed_speed() -> None:
    plant = lio_plant()
    q_goal = Q_START + np.array([0.3, 0.1, -0.2, 0.2, 0.1, -0.3])
    target = pose_of(IkSolver(plant, TCP), q_goal)
    builder = DiagramBuilder()
    pose = builder.AddSystem(ConstantVectorSource(target))
    weight = builder.AddSystem(ConstantVectorSource([5.0]))
    ik = OrientationWeightedIk.AddToBuilder(
        builder=builder,
        solver=IkSolver(plant, TCP),
        q_start=Q_START,
        X_BT_desired=pose.get_output_port(),
        orientation_weight=weight.get_output_port(),
    )
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = ik.GetMyContextFromRoot(simulator.get_mutable_context())
    v_max = ik.solver.v_max
    for step in range(100):
        simulator.AdvanceTo((step + 0.5) * CONTROL_PERIOD)
        command = ik.GetOutputPort("desired_state").Eval(context)
        assert np.all(np.abs(command[6:]) <= v_max + 1e-9)
    simulator.AdvanceTo(3.0)
    command = ik.GetOutputPort("desired_state").Eval(context)
    np.testing.assert_allclose(pose_of(ik.solver, command[:6])[:3], target[:3], atol=1e-4)


def test_replays_bit_for_bit_from_a_copied_context(solver: IkSolver) -> None:
    system = OrientationWeightedIk(solver, q_start=Q_START)
    context = system.CreateDefaultContext()
    system.GetInputPort("X_BT_desired").FixValue(context, pose_of(solver, Q_START + 0.2))
    system.GetInputPort("orientation_weight").FixValue(context, [1.0])
    ends = []
    for copy in (context.Clone(), context.Clone()):
        for _ in range(20):
            copy.SetDiscreteState(system.EvalUniquePeriodicDiscreteUpdate(copy))
        ends.append(system.GetOutputPort("desired_state").Eval(copy))
    np.testing.assert_array_equal(*ends)


def test_start_posture_of_wrong_size_is_refused(solver: IkSolver) -> None:
    with pytest.raises(InputError, match="6 finite joint positions"):
        OrientationWeightedIk(solver, q_start=np.zeros(5))
