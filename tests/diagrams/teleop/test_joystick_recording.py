"""Recorded joysticks: what a row means, both kinds of file, and files that cannot be used."""

import numpy as np
import pytest

from canal.errors import InputError
from diagrams.teleop.joystick_recording import JoystickRecording, load_recording

HEADER = "t,k_x,k_y,gripper,reverse,start,stop\n"
ROWS = np.array([[0, 0, 0, 0, 0, 1, 0], [0.5, 0.3, -0.4, 0, 0, 0, 0], [1.0, 0, 0, 1, 0, 0, 0], [2.0, 0, 0, 0, 0, 0, 0]])


def test_a_row_holds_until_the_next_and_the_last_one_ends_it():
    recording = JoystickRecording(ROWS[:, 0], ROWS[:, 1:])
    np.testing.assert_array_equal(recording.at(-0.1), np.zeros(6))
    np.testing.assert_array_equal(recording.at(0.0), ROWS[0, 1:])
    np.testing.assert_array_equal(recording.at(0.999), ROWS[1, 1:])
    np.testing.assert_array_equal(recording.at(1.0), ROWS[2, 1:])
    np.testing.assert_array_equal(recording.at(5.0), np.zeros(6))


def test_csv_and_npz_read_the_same(tmp_path):
    np.savez(tmp_path / "r.npz", time=ROWS[:, 0], stick=ROWS[:, 1:3], buttons=ROWS[:, 3:], more=np.arange(3))
    (tmp_path / "r.csv").write_text(HEADER + "\n".join(",".join(map(str, row)) for row in ROWS) + "\n\n")
    for path in (tmp_path / "r.npz", tmp_path / "r.csv"):
        recording = load_recording(path)
        np.testing.assert_array_equal(recording.time, ROWS[:, 0])
        np.testing.assert_array_equal(recording.joystick, ROWS[:, 1:])


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "empty"),
        ("time,x,y\n0,0,0\n", "first line"),
        (HEADER, "at least one row"),
        (HEADER + "0,0,0,0,0,0\n", "line 2 has 6 cells; give 7"),
        (HEADER + "0,0,0,0,0,0,0\n1,0,0\n", "line 3 has 3 cells; give 7"),
        (HEADER + "0,left,0,0,0,0,0\n", "not a number"),
        (HEADER + "0,0,0,0,0,0,0\nnan,0,0,0,0,0,0\n", "row 2 has a time"),
        (HEADER + "1,0,0,0,0,0,0\n1,0,0,0,0,0,0\n", "ascend"),
        (HEADER + "0,0,1.5,0,0,0,0\n", r"\[-1, 1\]"),
        (HEADER + "0,nan,0,0,0,0,0\n", r"\[-1, 1\]"),
        (HEADER + "0,0,0,0.5,0,0,0\n", "0 or 1"),
        ("\x00\xff", "first line"),
    ],
)
def test_csv_that_cannot_be_used(tmp_path, text, reason):
    (tmp_path / "r.csv").write_text(text)
    with pytest.raises(InputError, match=reason) as error:
        load_recording(tmp_path / "r.csv")
    assert "\n" not in str(error.value)


def test_bytes_that_are_no_text(tmp_path):
    (tmp_path / "r.csv").write_bytes(b"\xff\x00\x81")
    with pytest.raises(InputError, match="is not text"):
        load_recording(tmp_path / "r.csv")


@pytest.mark.parametrize(
    ("arrays", "reason"),
    [
        ({}, "no time, stick, buttons"),
        ({"time": [0.0], "stick": np.zeros((1, 2))}, "no buttons"),
        ({"time": [0.0], "stick": np.zeros((2, 2)), "buttons": np.zeros((1, 4))}, r"\(T, 2\)"),
        ({"time": 0.0, "stick": np.zeros((1, 2)), "buttons": np.zeros((1, 4))}, "shape"),
        ({"time": ["a"], "stick": np.zeros((1, 2)), "buttons": np.zeros((1, 4))}, "numbers"),
        ({"time": np.zeros(0), "stick": np.zeros((0, 2)), "buttons": np.zeros((0, 4))}, "at least one row"),
    ],
)
def test_npz_that_cannot_be_used(tmp_path, arrays, reason):
    np.savez(tmp_path / "r.npz", **arrays)
    with pytest.raises(InputError, match=reason):
        load_recording(tmp_path / "r.npz")


def test_never_unpickles(tmp_path):
    time = np.array([object()], dtype=object)
    np.savez(tmp_path / "r.npz", time=time, stick=np.zeros((1, 2)), buttons=np.zeros((1, 4)))
    with pytest.raises(InputError, match="without pickles"):
        load_recording(tmp_path / "r.npz")


@pytest.mark.parametrize(
    ("content", "reason"),
    [(b"", "empty"), (b"no zip at all", r"no \.npz"), (b"PK\x03\x04 broken", "cannot be read, damaged")],
)
def test_what_only_has_the_name_of_an_npz(tmp_path, content, reason):
    (tmp_path / "r.npz").write_bytes(content)
    with pytest.raises(InputError, match=reason):
        load_recording(tmp_path / "r.npz")


def test_a_file_that_is_missing(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        load_recording(tmp_path / "r.npz")
