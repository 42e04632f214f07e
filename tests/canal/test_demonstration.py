import numpy as np
import pytest

from canal.demonstration import Demonstration, load_demonstration, save_demonstration
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
