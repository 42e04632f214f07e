import numpy as np
import pytest

from canal.demonstration import (
    METRES,
    SECONDS,
    Demonstration,
    RecordingFormat,
    load_demonstration,
    save_demonstration,
)
from canal.errors import InputError

POSITION = np.column_stack([np.linspace(0, 0.5, 6), np.zeros(6), np.full(6, 0.4)])
ORIENTATION = np.tile([1.0, 0, 0, 0], (6, 1))


def test_time_defaults_to_twenty_hertz():
    d = Demonstration(POSITION, ORIENTATION)
    assert np.array_equal(d.time, np.arange(6) / 20)
    assert d.duration == pytest.approx(0.25)


def test_arrays_are_copies_that_cannot_be_written():
    mine = POSITION.copy()
    d = Demonstration(mine, 2 * ORIENTATION * 0.9)
    mine[0] = 7
    assert np.array_equal(d.position, POSITION)
    assert np.allclose(np.linalg.norm(d.orientation, axis=1), 1, atol=1e-15)
    with pytest.raises(ValueError, match="read-only"):
        d.position[0, 0] = 1


@pytest.mark.parametrize("suffix", [".npz", ".csv"])
def test_save_and_load_is_the_identity(tmp_path, suffix):
    d = Demonstration(POSITION * np.pi, ORIENTATION, np.cumsum([0.1, 0.2, 0.05, 0.3, 0.1, 0.1]))
    path = tmp_path / f"d{suffix}"
    save_demonstration(path, d)
    back = load_demonstration(path)
    for key in ("position", "orientation", "time"):
        assert np.array_equal(getattr(back, key), getattr(d, key))
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def _with(**changes):
    arrays = {"position": POSITION.copy(), "orientation": ORIENTATION.copy(), **changes}
    return {key: value for key, value in arrays.items() if value is not None}


def _nan_at_two():
    position = POSITION.copy()
    position[2, 1] = np.nan
    return position


BAD_ARRAYS = {
    "no keys": ({"foo": np.zeros(3)}, "position"),
    "no orientation": (_with(orientation=None), "orientation"),
    "NaN": (_with(position=_nan_at_two()), "not finite"),
    "one sample": (_with(position=POSITION[:1], orientation=ORIENTATION[:1]), "at least 4"),
    "zero quaternions": (_with(orientation=np.zeros((6, 4))), "norm 0"),
    "wrong shape": (_with(position=POSITION[:, :2]), "(N, 3)"),
    "lengths differ": (_with(orientation=ORIENTATION[:5]), "(6, 4)"),
    "time backwards": (_with(time=np.arange(6)[::-1] * 0.1), "does not increase"),
    "millimetres": (_with(position=POSITION * 1000), "metres"),
    "text": (_with(position=np.full((6, 3), "x")), "numbers"),
    "centimetres": (_with(position=POSITION * 100), "--units cm"),
    "one zero quaternion": (_with(orientation=np.where(np.arange(6)[:, None] == 4, 0.0, ORIENTATION)), "sample 4"),
    "times too close": (_with(time=np.array([0, 5e-312, 1, 2, 3, 4])), "at least 1e-05"),
    "complex": (_with(position=POSITION + 0j), "complex128"),
    "a number for a time": (_with(time=3.0), "shape"),
    "no samples": (_with(position=np.zeros((0, 3)), orientation=np.zeros((0, 4)), time=np.zeros(0)), "at least 4"),
}


@pytest.mark.parametrize("case", BAD_ARRAYS)
def test_bad_arrays_give_one_line(tmp_path, case):
    arrays, says = BAD_ARRAYS[case]
    path = tmp_path / "bad.npz"
    np.savez(path, **arrays)
    with pytest.raises(InputError) as caught:
        load_demonstration(path)
    message = str(caught.value)
    assert says in message
    assert "bad.npz" in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (None, "no such file"),
        (b"", "empty"),
        (b"this is no archive", "cannot be read"),
        (b"PK\x03\x04 but then not", "cannot be read"),
    ],
)
def test_bad_files_give_one_line(tmp_path, content, says):
    path = tmp_path / "bad.npz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=says):
        load_demonstration(path)


@pytest.mark.parametrize("units", METRES)
def test_lengths_in_other_units(tmp_path, units):
    np.savez(tmp_path / "d.npz", position=POSITION / METRES[units], orientation=ORIENTATION)
    d = load_demonstration(tmp_path / "d.npz", RecordingFormat(units=units))
    assert np.allclose(d.position, POSITION, rtol=1e-15, atol=1e-15)


@pytest.mark.parametrize("unit", SECONDS)
def test_times_in_other_units(tmp_path, unit):
    start = 1.79e9 if unit != "s" else 0.0  # as clocks count, from 1970 on
    np.savez(
        tmp_path / "d.npz", position=POSITION, orientation=ORIENTATION, time=(start + np.arange(6) / 20) / SECONDS[unit]
    )
    d = load_demonstration(tmp_path / "d.npz", RecordingFormat(time_unit=unit))
    assert np.allclose(d.time - d.time[0], np.arange(6) / 20, atol=1e-6)


def test_quaternions_in_the_other_order(tmp_path):
    orientation = np.tile([0.1, 0.2, 0.3, 0.4], (6, 1))
    np.savez(tmp_path / "d.npz", position=POSITION, orientation=np.roll(orientation, -1, axis=1))
    d = load_demonstration(tmp_path / "d.npz", RecordingFormat(quaternion_order="xyzw"))
    assert np.allclose(d.orientation, orientation / np.linalg.norm(orientation[0]))
    rows = np.column_stack([np.arange(6) / 20, POSITION, np.roll(orientation, -1, axis=1)])
    header = "t,x,y,z,qx,qy,qz,qw"  # a table names its columns
    np.savetxt(tmp_path / "d.csv", rows, delimiter=",", header=header, comments="")
    assert np.allclose(load_demonstration(tmp_path / "d.csv").orientation, d.orientation)


def test_bad_samples_are_dropped_and_counted_when_told(tmp_path):
    n = 40
    position = np.column_stack([np.linspace(0, 0.5, n), np.zeros(n), np.full(n, 0.4)])
    orientation, time = np.tile([1.0, 0, 0, 0], (n, 1)), np.arange(n) / 20
    position[3, 1], position[9] = np.nan, np.inf
    orientation[7], orientation[8] = 0, 1e-3
    time[20], time[30] = time[19], -1.0
    good = np.setdiff1d(np.arange(n), [3, 7, 8, 9, 20, 30])
    np.savez(tmp_path / "d.npz", position=position, orientation=orientation, time=time)
    with pytest.raises(InputError, match="--drop-bad-samples"):
        load_demonstration(tmp_path / "d.npz")
    d = load_demonstration(tmp_path / "d.npz", RecordingFormat(drop_bad_samples=True))
    assert d.dropped == 6
    assert np.array_equal(d.position, position[good])
    assert np.array_equal(d.time, time[good])
    np.savez(tmp_path / "untimed.npz", position=position, orientation=orientation)
    d = load_demonstration(tmp_path / "untimed.npz", RecordingFormat(drop_bad_samples=True))
    assert d.dropped == 4
    assert d.time[3] == pytest.approx(4 / 20)  # the time goes on while nothing is known


def test_dropping_samples_hides_no_mistake_that_all_have(tmp_path):
    drop = RecordingFormat(drop_bad_samples=True)
    np.savez(tmp_path / "d.npz", position=100 * POSITION, orientation=ORIENTATION)
    with pytest.raises(InputError, match="--units cm"):
        load_demonstration(tmp_path / "d.npz", drop)
    np.savez(tmp_path / "d.npz", position=POSITION, orientation=0 * ORIENTATION)
    with pytest.raises(InputError, match="0 of 6 samples can be used"):
        load_demonstration(tmp_path / "d.npz", drop)


def test_a_table_names_the_line(tmp_path):
    rows = "\n".join(f"{k / 20},{k / 10},0,0.4,1,0,0,{'nan' if k == 3 else 0}" for k in range(6))
    (tmp_path / "d.csv").write_text(f"t,x,y,z,qw,qx,qy,qz\n\n{rows}\n")
    with pytest.raises(InputError, match=r"sample 3 \(line 6\)"):
        load_demonstration(tmp_path / "d.csv")


def test_options_of_reading_are_checked():
    with pytest.raises(InputError, match=r"units is 'miles'; give one of m, cm"):
        RecordingFormat(units="miles")


def test_a_pickle_is_never_unpickled(tmp_path):
    path = tmp_path / "evil.npz"
    np.savez(path, position=np.array([{"a": 1}], dtype=object), orientation=ORIENTATION, allow_pickle=True)
    with pytest.raises(InputError, match="without pickles"):
        load_demonstration(path)


@pytest.mark.parametrize(
    "text", ["", "a,b,c\n1,2,3\n", "t,x,y,z,qw,qx,qy,qz\n0,1,2\n", "t,x,y,z,qw,qx,qy,qz\n0,1,2,3,a,0,0,0\n"]
)
def test_bad_csv_gives_one_line(tmp_path, text):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=r"bad\.csv"):
        load_demonstration(path)


def test_a_place_that_cannot_be_written_gives_one_line(tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        save_demonstration(tmp_path / "nowhere" / "d.npz", Demonstration(POSITION, ORIENTATION))
