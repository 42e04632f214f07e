"""What is recorded, taken back, paused and gone on from."""

import numpy as np
import pytest

from canal.errors import InputError
from diagrams.teach.path import MOST, PATIENCE, UNDO_S, TaughtPath, Word

EMPTY = TaughtPath(np.empty((0, 7)))


def pose(k):
    return np.array([0.005 * k, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0])


def walk(path, begin, end):
    for k in range(begin, end):
        path = path.moved(pose(k))
    return path


def follow(path, most=1000):
    """The tool goes where the path leads it."""
    for _ in range(most):
        if not path.leads_back:
            return path
        path = path.moved(path.poses[-1])
    raise AssertionError("it never ends")


def test_standing_still_takes_no_time():
    path = EMPTY.told(Word.RECORD, pushed=False)
    for k in (0, 0, 0, 1, 1, 2, 3, 3, 4):
        path = path.moved(pose(k))
    assert path.kept == 5
    assert path.demonstration("d").time.tolist() == pytest.approx([0, 0.05, 0.10, 0.15, 0.20])


def test_what_is_moved_before_record_is_not_in_it():
    path = walk(EMPTY, 0, 30).told(Word.RECORD, pushed=False)
    path = walk(path, 30, 40)
    assert path.demonstration("d").position[0] == pytest.approx(pose(30)[:3])
    assert len(path.demonstration("d")) == 10


def test_undo_goes_back_the_way_it_came_and_records_on():
    path = walk(EMPTY.told(Word.RECORD, pushed=False), 0, 100).told(Word.UNDO, pushed=False)
    assert path.leads_back
    assert not path.recording
    path = follow(path)
    assert path.recording
    assert len(path.poses) == path.kept == 100 - UNDO_S * 20
    assert path.poses[-1] == pytest.approx(pose(path.kept - 1))
    path = follow(walk(path, path.kept, 70).told(Word.UNDO, pushed=False).told(Word.UNDO, pushed=False))
    assert path.kept <= 1, "pressed twice, it takes back twice as much"


def test_the_way_back_waits_for_the_tool():
    path = walk(EMPTY.told(Word.RECORD, pushed=False), 0, 100).told(Word.UNDO, pushed=False)
    for _ in range(50):
        path = path.moved(pose(140))  # something holds it
    assert len(path.poses) == 100


def test_the_way_back_ends_where_the_tool_comes_no_nearer():
    pressed = np.array([0.0, 0.0, 0.006, 0.0, 0.0, 0.0, 0.0])  # a table that it pressed on keeps it so far off
    path = walk(EMPTY.told(Word.RECORD, pushed=False), 0, 30).told(Word.BACK, pushed=False)
    samples = 0
    while path.leads_back:
        path = path.moved(path.poses[-1] + pressed)
        samples += 1
    assert len(path.poses) == 1
    assert samples == 29 + PATIENCE + 1
    again = walk(path, 100, 130).told(Word.BACK, pushed=False)
    assert again.waited == 0, "it waits as long the next time"


def test_a_push_ends_the_way_back():
    path = walk(EMPTY.told(Word.RECORD, pushed=False), 0, 100).told(Word.UNDO, pushed=False)
    path = path.moved(path.poses[-1]).told(Word.NOTHING, pushed=True)
    assert not path.leads_back
    assert not path.recording
    assert path.told(Word.UNDO, pushed=False).told(Word.STAND, pushed=False).back_to == -1


def test_a_recording_goes_on_from_where_it_paused():
    path = walk(EMPTY.told(Word.RECORD, pushed=False), 0, 50).told(Word.PAUSE, pushed=False)
    path = walk(path, 50, 80)
    assert path.kept == 50
    path = path.told(Word.RECORD, pushed=False)
    assert path.leads_back
    path = follow(path)
    assert path.recording
    assert path.poses[-1] == pytest.approx(pose(49))
    d = walk(path, 50, 60).demonstration("d")
    assert np.linalg.norm(np.diff(d.position, axis=0), axis=1).max() < 0.006, "no jump where it went on"


def test_back_leads_to_the_beginning_also_after_saving():
    path = walk(EMPTY.told(Word.RECORD, pushed=False), 0, 60).forgotten()
    assert not path.kept
    path = follow(walk(path, 60, 70).told(Word.BACK, pushed=False))
    assert path.poses[-1] == pytest.approx(pose(0))
    assert not path.recording
    path = path.told(Word.RECORD, pushed=False)
    assert path.recording
    assert path.kept == 0


def test_too_short_is_refused():
    with pytest.raises(InputError, match="samples"):
        walk(EMPTY.told(Word.RECORD, pushed=False), 0, 3).demonstration("d")


def test_memory_is_bounded():
    full = TaughtPath(np.tile(pose(0), (MOST, 1)), kept=MOST, recording=True)
    assert not full.moved(pose(9)).recording
    assert len(full.moved(pose(9)).poses) == MOST
    idle = TaughtPath(np.tile(pose(0), (MOST, 1)))
    assert len(idle.moved(pose(9)).poses) == MOST // 2 + 1
