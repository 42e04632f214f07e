"""The simulated operator alone, in a world without physics: what is gripped within 4 cm sticks to the gripper."""

import numpy as np
import pytest
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder, LeafSystem

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.navigation import FIELD_NAMES, NavigationState
from diagrams.geometry.goals import DrumGoal, MarkGoal
from diagrams.navigator import CanalNavigator
from diagrams.operator.options import OperatorOptions
from diagrams.operator.system import SimulatedOperator

REACH_OF_FINGERS = 0.04


def arch(side: float) -> Demonstration:
    t = np.linspace(0, 1, 300)
    x = 0.4 + side * np.abs(np.cos(np.pi * t)) ** 0.5
    position = np.column_stack([x, -0.4 * np.cos(np.pi * t), 0.5 + 0.4 * np.sin(np.pi * t)])
    return Demonstration(position, np.tile([1.0, 0, 0, 0], (300, 1)), np.arange(300) / 20.0, f"arch {side}")


class StickyWorld(LeafSystem):
    """The TCP is where it is wanted; an item within reach of closing fingers is carried until they open."""

    def __init__(self, items: np.ndarray, slips: int = 0):
        super().__init__()
        self.n = len(items)
        self.pose = self.DeclareVectorInputPort("X_BT_desired", 7)
        self.gripper = self.DeclareVectorInputPort("gripper_command", 1)
        # Positions, which is held (-1 none), grip so far, grips that slip.
        self.DeclareDiscreteState(np.concatenate([items.ravel(), [-1, 0, slips]]))
        self.DeclareVectorOutputPort("item_poses", 7 * self.n, self.poses)
        self.DeclareVectorOutputPort("item_bounds", 6 * self.n, self.bounds)
        self.DeclarePeriodicDiscreteUpdateEvent(0.01, 0.0, self.update)

    def positions(self, context):
        return context.get_discrete_state(0).value()[:-3].reshape(self.n, 3)

    def poses(self, context, output):
        output.set_value(np.hstack([self.positions(context), np.tile([1.0, 0, 0, 0], (self.n, 1))]).ravel())

    def bounds(self, context, output):
        items = self.positions(context)
        output.set_value(np.hstack([items - 0.03, items + 0.03]).ravel())

    def update(self, context, discrete):
        held, was_closed, slips = context.get_discrete_state(0).value()[-3:]
        items = self.positions(context).copy()
        p, closed = self.pose.Eval(context)[:3], self.gripper.Eval(context)[0]
        if closed and not was_closed:
            distance = np.linalg.norm(items - p, axis=1)
            if distance.min() < REACH_OF_FINGERS:
                held, slips = (distance.argmin(), slips) if slips <= 0 else (-1, slips - 1)
        if not closed:
            held = -1
        if held >= 0:
            items[int(held)] = p
        discrete.set_value(0, np.concatenate([items.ravel(), [held, closed, slips]]))


def load(items, goals, *, slips=0, seconds=240.0, seed=0, X_WB=None, options=None):
    X_WB = X_WB or RigidTransform()
    canal = learn_canal([arch(-0.12), arch(0.12)])
    builder = DiagramBuilder()
    navigator = CanalNavigator.AddToBuilder(builder=builder, canal=canal)
    person = SimulatedOperator.AddToBuilder(
        builder=builder, canal=canal, goals=goals, X_WB=X_WB, options=options, seed=seed
    )
    world = builder.AddSystem(StickyWorld(items, slips))
    builder.Connect(person.GetOutputPort("joystick"), navigator.GetInputPort("joystick"))
    for port in ("X_BT_desired", "gripper_command"):
        builder.Connect(navigator.GetOutputPort(port), world.GetInputPort(port))
    builder.Connect(navigator.GetOutputPort("X_BT_desired"), person.GetInputPort("X_BT"))
    builder.Connect(navigator.GetOutputPort("navigation_state"), person.GetInputPort("navigation_state"))
    for port in ("item_poses", "item_bounds"):
        builder.Connect(world.GetOutputPort(port), person.GetInputPort(port))
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    navigator.GetInputPort("gripper_state").FixValue(navigator.GetMyMutableContextFromRoot(context), [0.0, 0.0])
    simulator = Simulator(diagram, context)

    def stopped(root):
        vector = navigator.GetOutputPort("navigation_state").Eval(navigator.GetMyContextFromRoot(root))
        state = NavigationState.from_vector(vector)
        from pydrake.systems.framework import EventStatus

        if root.get_time() > 5 and not state.running:
            return EventStatus.ReachedTermination(diagram, "stopped")
        return EventStatus.DidNothing()

    simulator.set_monitor(stopped)
    simulator.AdvanceTo(seconds)
    root = simulator.get_context()
    state = NavigationState.from_vector(
        navigator.GetOutputPort("navigation_state").Eval(navigator.GetMyContextFromRoot(root))
    )
    return world.positions(world.GetMyContextFromRoot(root)), state, root.get_time()


PICK = np.array([0.4, -0.4, 0.5])
PLACE = np.array([0.4, 0.4, 0.5])


def test_brings_each_item_to_its_mark():
    items = PICK + np.array([[0.06, 0, 0], [-0.05, 0, 0.0], [0.0, 0, 0.0]])
    marks = PLACE + np.array([[-0.07, 0, 0], [0.02, 0, 0], [0.08, 0, 0]])
    end, state, time = load(items, [MarkGoal(m) for m in marks])
    assert np.linalg.norm(end - marks, axis=1).max() < 0.03
    assert state.corrections >= 3
    assert state.backtracks == 0
    assert not state.running, "stops when all is done"
    assert time < 240


def test_goes_back_when_a_grip_did_not_hold():
    end, state, _ = load(PICK[None] + [[0.05, 0, 0]], [MarkGoal(PLACE)], slips=2)
    assert np.linalg.norm(end[0] - PLACE) < 0.03
    assert state.backtracks >= 2


def test_pushes_in_what_hangs_out_and_then_gives_up():
    # The drum lies beyond the canal's end: in this world nothing pushed moves, so the item stays out.
    goal = DrumGoal(p_WD=PLACE + [0, 0.1, 0], inward=np.array([0, 1.0, 0]), depth=0.3, radius=0.25)
    _, state, _ = load(PICK[None], [goal], seconds=400)
    assert state.backtracks >= 4
    assert not state.running, "gives up, and says so by stopping"


def test_an_item_let_go_too_early_is_pushed_in():
    # Behind the door only at the canal's end; what sticks to the closed gripper stands for what is pushed.
    goal = DrumGoal(p_WD=PLACE - [0, 0.04, 0], inward=np.array([0, 1.0, 0]), depth=0.3, radius=0.25, clearance=0.02)
    early = OperatorOptions(let_go_at=0.7)
    _, sure, _ = load(PICK[None], [goal], seconds=60)
    _, slipping, _ = load(PICK[None], [goal], seconds=60, options=early)
    assert sure.backtracks == 0
    assert slipping.backtracks >= 2, "back off, and in again"
    marked, state, _ = load(PICK[None], [MarkGoal(PLACE)], options=early)
    assert np.linalg.norm(marked[0] - PLACE) < 0.03, "what has a mark is not let go before it"
    assert state.backtracks == 0


def test_what_may_lie_anywhere_is_laid_side_by_side():
    goal = DrumGoal(p_WD=PLACE - [0, 0.1, 0], inward=np.array([0, 1.0, 0]), depth=0.4, radius=0.3)
    items = PICK + np.array([[0.06, 0, 0], [-0.05, 0, 0], [0.0, 0, 0.0]])
    end, state, _ = load(items, [goal] * 3)
    left, middle, right = np.sort(end[:, 0])
    assert right - middle > 0.07
    assert middle - left > 0.07
    assert state.backtracks == 0


def test_leaves_out_of_reach_alone():
    end, state, _ = load(PICK + np.array([[0, 0, 0], [0.9, 0, 0]]), [MarkGoal(PLACE), MarkGoal(PLACE)])
    assert np.linalg.norm(end[0] - PLACE) < 0.03
    np.testing.assert_array_equal(end[1], PICK + [0.9, 0, 0])
    assert not state.running


def test_same_seed_same_run():
    first, second, other = (load(PICK[None] + [[0.05, 0, 0]], [MarkGoal(PLACE)], seed=s)[:2] for s in (3, 3, 4))
    np.testing.assert_array_equal(first[0], second[0])
    assert first[1] == second[1]
    assert first[1] != other[1]


def test_delay_must_be_whole_samples():
    from canal.errors import InputError

    with pytest.raises(InputError, match="delay_s"):
        OperatorOptions(delay_s=0.13)


def test_state_vector_is_as_long_as_it_says():
    assert len(FIELD_NAMES) == NavigationState(disk=0.0).to_vector().size
