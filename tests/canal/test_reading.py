import contextlib
import io
import os
import zipfile
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from canal.errors import InputError
from canal.reading import LARGEST_BYTES, as_numbers, read_csv, read_npz

WHAT = "a table (.npz or .csv)"
COLUMNS = ("t", "x")


def _npy(array, **changes) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array)
    content = stream.getvalue()
    for old, new in changes.pop("replace", []):
        content = content.replace(old, new)
    return content


def _archive(path, members: dict[str, bytes], compression=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def _refused(read, *arguments) -> str:
    with pytest.raises(InputError) as caught:
        read(*arguments)
    message = str(caught.value)
    assert "\n" not in message
    return message


def _damaged(content: bytes, at: int, value: int) -> bytes:
    content = bytearray(content)
    content[at] = value
    return bytes(content)


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_come_back_whatever_their_order_and_type(tmp_path, save):
    rng = np.random.default_rng(0)
    arrays = {
        "columns": np.asfortranarray(rng.normal(size=(5, 3))),
        "big": rng.normal(size=4).astype(">f8"),
        "half": np.arange(3, dtype=np.float16),
        "whole": np.arange(7, dtype=np.uint16),
        "flags": np.array([True, False]),
        "text": np.array(["pick", "place"]),
        "one": np.array(2.5),
        "none": np.zeros((0, 3)),
    }
    save(tmp_path / "a.npz", **arrays)
    back = read_npz(tmp_path / "a.npz", WHAT)
    assert set(back) == set(arrays)
    for key, array in arrays.items():
        assert np.array_equal(back[key], array)
        assert back[key].shape == array.shape
    assert set(read_npz(tmp_path / "a.npz", WHAT, ("big", "not there"))) == {"big"}


def test_an_array_nobody_asks_for_may_be_anything(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.arange(3), other=np.array([{}], dtype=object), allow_pickle=True)
    assert np.array_equal(read_npz(tmp_path / "a.npz", WHAT, ("x",))["x"], np.arange(3))
    assert "without pickles" in _refused(read_npz, tmp_path / "a.npz", WHAT)


@pytest.mark.parametrize("dtype", [complex, "datetime64[s]", "S3", [("a", float)], "V4"])
def test_odd_types_are_refused(tmp_path, dtype):
    np.savez(tmp_path / "a.npz", x=np.zeros(3, dtype=dtype))
    assert "array 'x' holds" in _refused(read_npz, tmp_path / "a.npz", WHAT)


def test_text_is_no_number():
    assert "give numbers" in _refused(as_numbers, np.array(["a"]), "x")
    assert np.isinf(as_numbers(np.array([np.longdouble("1e4000")]), "x")).all()


@pytest.mark.parametrize("shape", [b"(1000000000000, 3)", b"(1, 3)", b"(-2, -3)", b"(99999999999999999999999, 0)"])
def test_no_array_larger_than_its_bytes_is_made(tmp_path, shape):
    content = _npy(np.zeros((2, 3)))
    header = b"(2, 3), }" + b" " * (len(shape) - len(b"(2, 3)"))
    content = content.replace(header, (shape + b", }").ljust(len(header)))
    _archive(tmp_path / "a.npz", {"x.npy": content})
    assert "damaged" in _refused(read_npz, tmp_path / "a.npz", WHAT)


@pytest.mark.parametrize("compression", [zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_a_bomb_is_refused_before_it_is_unpacked(tmp_path, compression):
    path = tmp_path / "a.npz"
    with zipfile.ZipFile(path, "w", compression) as archive, archive.open("x.npy", "w", force_zip64=True) as member:
        for _ in range(LARGEST_BYTES // 2**24 + 1):
            member.write(bytes(2**24))
    assert path.stat().st_size < 1e6
    assert "MB" in _refused(read_npz, path, WHAT)


def test_encrypted_archives_are_refused(tmp_path):
    path = _archive(tmp_path / "a.npz", {"x.npy": _npy(np.zeros(3))})
    content = path.read_bytes()
    local, central = content.index(b"PK\x03\x04") + 6, content.index(b"PK\x01\x02") + 8
    path.write_bytes(_damaged(_damaged(content, local, 1), central, 1))
    assert "encrypted" in _refused(read_npz, path, WHAT)


def test_headers_that_are_no_headers(tmp_path):
    for header in (b"{" * 16, b"{'descr': '<f8'}", b"\xff" * 16, b"(" * 4000, b"__import__('os')"):
        content = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header
        path = _archive(tmp_path / "a.npz", {"x.npy": content})
        assert "cannot be read" in _refused(read_npz, path, WHAT)


def test_a_bare_array_says_how_to_make_an_archive(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros(3))
    assert "np.savez" in _refused(read_npz, tmp_path / "a.npy", WHAT)


@settings(max_examples=200, deadline=None)
@given(at=st.integers(0, 10**6), value=st.integers(0, 255), cut=st.integers(0, 400))
def test_any_byte_may_be_damaged(tmp_path_factory, at, value, cut):
    path = tmp_path_factory.getbasetemp() / "damaged.npz"
    np.savez_compressed(path, x=np.linspace(0, 1, 40), y=np.arange(3))
    content = path.read_bytes()
    content = _damaged(content, at % len(content), value)[: len(content) - (cut if cut > 200 else 0)]
    path.write_bytes(content)
    arrays = {}
    with contextlib.suppress(InputError):
        arrays = read_npz(path, WHAT)
    assert all(isinstance(array, np.ndarray) for array in arrays.values())


@pytest.mark.parametrize("read", [lambda path: read_npz(path, WHAT), lambda path: read_csv(path, WHAT, COLUMNS)])
def test_places_without_a_file(tmp_path, read, monkeypatch):
    assert "no such file" in _refused(read, tmp_path / "missing")
    assert "is a folder" in _refused(read, tmp_path)
    assert "cannot be read" in _refused(read, tmp_path / ("n" * 300))
    assert "cannot be read" in _refused(read, str(tmp_path / "null\0byte"))
    assert "cannot be read" in _refused(read, tmp_path / "missing" / ".." / "loop" if _loop(tmp_path) else tmp_path)
    os.mkfifo(tmp_path / "pipe")
    assert "is a pipe" in _refused(read, tmp_path / "pipe")
    (tmp_path / "file").write_bytes(b"")
    assert "empty" in _refused(read, tmp_path / "file")

    def denied(path):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "stat", denied)
    assert "Permission denied" in _refused(read, tmp_path / "file")


def _loop(folder) -> bool:
    (folder / "missing").mkdir()
    (folder / "loop").symlink_to("loop")
    return True


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_tables_by_the_names_of_their_columns(tmp_path, encoding):
    path = tmp_path / "a.csv"
    path.write_text('X, "T",\r\n\r\n1.5, 0,,\r\n,,\r\n-2e-1,"1"\r\n2,\r\n', encoding=encoding)
    table, lines = read_csv(path, WHAT, COLUMNS)
    assert np.array_equal(table, [[0, 1.5], [1, -0.2], [np.nan, 2]], equal_nan=True)
    assert lines.tolist() == [3, 5, 6]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("t;x\n0,5;1\n", "semicolons and decimal commas"),
        ("t;x\n0.5;1\n", "has semicolons, as"),
        ("t\tx\n0,5\t1\n", "tabs and decimal commas"),
        ("t,y\n0,1\n", "lacks x"),
        ("t,x,t\n0,1,0\n", "one twice"),
        ("0,1\n", "first line must be t,x"),
        ('t,x\n"0,5",1\n', "line 2 has '0,5', which is not a number; write a point"),
        ("t,x\n0,1\n1_0,1\n", "line 3"),
        ("t,x\n0,1,2\n", "line 2 has 3 cells"),
        ("t,x\n0,one\n", "not a number"),
        ("t,x\n" + 200_000 * "1" + ",0\n", "cannot be read"),
    ],
)
def test_tables_that_are_none(tmp_path, text, says):
    (tmp_path / "a.csv").write_text(text)
    assert says in _refused(read_csv, tmp_path / "a.csv", WHAT, COLUMNS)


def test_bytes_that_are_no_table(tmp_path):
    (tmp_path / "a.csv").write_bytes(zlib.compress(b"t,x"))
    assert "not text" in _refused(read_csv, tmp_path / "a.csv", WHAT, COLUMNS)
