"""The whole diagram of a lesson: a scripted hand moves the robot, and what it did is recorded and taken back."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from diagrams.scenario import load_scenario
from diagrams.teach.live_jog import TeachSample
from diagrams.teach.path import Word
from diagrams.teaching import build_teaching

HOME = np.array([-1.54, -0.36, 1.14, -0.03, 1.68, 0.03])
"""[rad] Where the shipped relocation begins."""


class Hand:
    """A hand that holds what a test gives it."""

    def __init__(self):
        self.jog, self.words, self.grip = np.zeros(7), [], False

    def read(self):
        grip, self.grip = self.grip, False
        return TeachSample(self.jog, grip, self.words.pop(0) if self.words else Word.NOTHING)


@pytest.fixture(scope="module")
def teaching():
    hand = Hand()
    return hand, build_teaching(scenario=load_scenario("relocation"), read=hand.read, q_start=HOME)


@pytest.fixture
def lesson(teaching):
    hand, system = teaching
    hand.__init__()
    simulator = Simulator(system.diagram)
    simulator.Initialize()

    def run(seconds, jog=(0,) * 7, word=Word.NOTHING):
        hand.jog = np.array(jog, dtype=float)
        hand.words = [word]
        simulator.AdvanceTo(simulator.get_context().get_time() + seconds)
        return value(system.station, "X_BT")

    def value(part, port):
        return part.GetOutputPort(port).Eval(part.GetMyContextFromRoot(simulator.get_context())).copy()

    run.value, run.root, run.hand, run.system = value, simulator.get_mutable_context(), hand, system
    return run


def test_the_tool_follows_the_hand_and_stands_when_it_lets_go(lesson):
    before = lesson(0.2)
    after = lesson(1.0, (0, 0, -1, 0, 0, 0, 0))
    assert after[2] - before[2] == pytest.approx(-0.095, abs=0.012)
    assert after[:2] == pytest.approx(before[:2], abs=0.004)
    stands = lesson(0.3)
    assert lesson(1.0) == pytest.approx(stands, abs=1e-3)


def test_an_arm_at_the_end_of_its_reach_waits_within_its_limits(lesson):
    lesson(9.0, (1, 0, 0.2, 0, 0, 0, 0))
    assert lesson.value(lesson.system.jog, "waited")[0] > 0.2
    status = lesson.value(lesson.system.ik, "ik_status")
    assert status[2] <= 1e-9, "no bound is violated"
    out = lesson(0.5)[0]
    back = lesson(1.0, (-1, 0, 0, 0, 0, 0, 0))[0]
    assert back - out < -0.07, "it comes back at once"


def test_a_table_is_not_pressed_on(lesson):
    """Lowered onto a table for seconds, the hand pushes no harder than the limit, and comes off it."""
    lesson(4.2, (-0.25, -0.95, -0.3, 0, 0, 0, 0))
    lesson(6.0, (0, 0, -1, 0, 0, 0, 0))
    lowest = lesson(0.5)[2]
    forces = lesson.value(lesson.system.station, "contact_forces")
    assert forces.max() < 2 * load_scenario("relocation").monitor.force_limit_n
    assert lesson(1.5, (0, 0, 1, 0, 0, 0, 0))[2] > lowest + 0.05


def test_a_recording_is_taken_back_along_its_path(lesson):
    recorder = lesson.system.recorder
    lesson(0.2, word=Word.RECORD)
    lesson(4.0, (0, -1, 0, 0, 0, 0, 0))
    full = recorder.path(lesson.root)
    assert full.kept == pytest.approx(80, abs=4)
    lesson(4.0, word=Word.UNDO)
    left = recorder.path(lesson.root)
    assert left.kept == pytest.approx(full.kept - 40, abs=3)
    assert left.recording
    assert lesson.value(lesson.system.station, "X_BT") == pytest.approx(left.poses[-1], abs=0.006)
    d = left.demonstration("d")
    assert np.linalg.norm(np.diff(d.position, axis=0), axis=1).max() < 0.008
    recorder.forget(lesson.root)
    assert recorder.path(lesson.root).kept == 0


def test_the_gripper_closes_and_opens(lesson):
    assert lesson.value(lesson.system.hand, "gripper_command")[0] == 0
    lesson.hand.grip = True
    lesson(1.0)
    assert lesson.value(lesson.system.hand, "gripper_command")[0] == 1
    assert lesson.value(lesson.system.station, "gripper_state")[0] < 0.1
    lesson.hand.grip = True
    lesson(1.0)
    assert lesson.value(lesson.system.station, "gripper_state")[0] > 0.4


def test_two_lessons_of_one_context_do_not_share_their_paths(lesson):
    lesson(0.2, word=Word.RECORD)
    lesson(1.0, (0, 0, 1, 0, 0, 0, 0))
    other = lesson.root.Clone()
    kept = lesson.system.recorder.path(other).kept
    lesson(1.0, (0, 0, 1, 0, 0, 0, 0))
    assert lesson.system.recorder.path(other).kept == kept < lesson.system.recorder.path(lesson.root).kept
