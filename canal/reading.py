"""Files that people bring, `.npz` archives and CSV tables: one that is damaged, odd or hostile ends in one line."""

from __future__ import annotations

import csv
import io
import os
import stat
import zipfile
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from canal.errors import InputError

LARGEST_BYTES = 2**27  # of a file and of an array in it: 20 Hz recordings of 23 days, logs of many hours
_CHUNK = {zipfile.ZIP_STORED: 2**16, zipfile.ZIP_DEFLATED: 2**16}
_SMALL_CHUNK = 2**12  # for what zipfile unpacks without a bound: bzip2 makes at most 82 MB of it, LZMA 28 MB
_PLAIN = {"f": "numbers", "i": "numbers", "u": "numbers", "b": "truth values", "U": "text"}
_BOMS = ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))


@contextmanager
def reading(path: str | os.PathLike[str], what: str) -> Iterator[None]:
    """The one place where whatever a file makes its reader raise becomes a line.

    Args:
        path: the file, for the message.
        what: what it should be, for the message: "a demonstration (.npz or .csv)".

    Raises:
        InputError: instead of any other exception.
    """
    try:
        yield
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; give {what}") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error}); give {what}") from None
    except Exception as error:  # zlib, lzma, tokenize, struct, zipfile, numpy, memory: what bytes can do is endless
        words = " ".join(str(error).split())[:80]
        why = f"{type(error).__name__}{': ' if words else ''}{words}"
        raise InputError(f"{path}: cannot be read, damaged or of another kind ({why}); give {what}") from None


def open_file(path: str | os.PathLike[str], what: str) -> io.BufferedReader:
    """A regular file that is there, is not empty and not too large, open for reading. Pipes and devices would hang.

    Args:
        path: of the file.
        what: belongs there, for messages.

    Raises:
        InputError: it is not such a file.
        OSError: likewise; see `reading`.
    """
    status = os.stat(path)
    if stat.S_ISDIR(status.st_mode):
        raise InputError(f"{path}: is a folder; give {what}")
    if not stat.S_ISREG(status.st_mode):
        raise InputError(f"{path}: is a pipe or a device; write it to a file first, and give {what}")
    if status.st_size == 0:
        raise InputError(f"{path}: the file is empty; give {what}")
    if status.st_size > LARGEST_BYTES:
        raise InputError(f"{path}: has {status.st_size / 1e6:.0f} MB (at most {LARGEST_BYTES / 1e6:.0f}); give {what}")
    return open(path, "rb")


def read_npz(path: str | os.PathLike[str], what: str, keys: Collection[str] | None = None) -> dict[str, np.ndarray]:
    """Arrays of an `.npz`, never unpickling, never making an array larger than what the file holds.

    Args:
        path: the file.
        what: what it should be, for messages.
        keys: the arrays that are wanted, where the file has them; None for all. Others are not looked at.

    Returns:
        Arrays of numbers, truth values or text by their names.

    Raises:
        InputError: it cannot be read as such.
    """
    with reading(path, what), open_file(path, what) as stream:
        start = stream.read(6)
        if start == b"\x93NUMPY":
            raise InputError(
                f"{path}: an .npy holds one bare array; save all that belong to {what} into one .npz, "
                "np.savez(NAME, position=..., orientation=...) for a demonstration"
            )
        if start[:2] != b"PK":
            raise InputError(f"{path}: cannot be read, it is no .npz as np.savez writes it; give {what}")
        with zipfile.ZipFile(stream) as archive:
            members = [(info.filename.removesuffix(".npy"), info) for info in archive.infolist()]
            members = [(key, info) for key, info in members if keys is None or key in keys]
            if len({key for key, _ in members}) < len(members):
                raise InputError(f"{path}: holds two arrays of one name; give {what} with one of each")
            if sum(info.file_size for _, info in members) > LARGEST_BYTES:
                raise InputError(f"{path}: its arrays take more than {LARGEST_BYTES / 1e6:.0f} MB; give {what}")
            return {key: _read_array(archive, info, f"{path}: array '{key}'") for key, info in members}


def _read_array(archive: zipfile.ZipFile, info: zipfile.ZipInfo, label: str) -> np.ndarray:
    """One array of an archive; `label` names it in messages."""
    if info.flag_bits & 1:
        raise InputError(f"{label} is encrypted; save it without a password")
    content = bytearray()
    with archive.open(info) as member:
        while chunk := member.read(_CHUNK.get(info.compress_type, _SMALL_CHUNK)):
            content += chunk
    stream = io.BytesIO(content)
    version = np.lib.format.read_magic(stream)
    read_header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, by_columns, dtype = read_header(stream)
    if dtype.kind not in _PLAIN or dtype.itemsize == 0:
        raise InputError(f"{label} holds {dtype}, not plain numbers; save it as an array of numbers, without pickles")
    count = 1
    for side in shape:  # of Python's numbers: they do not overflow
        count *= side
    data = memoryview(content)[stream.tell() :]
    if min(shape, default=1) < 0 or count * dtype.itemsize != len(data):
        raise InputError(f"{label} says that it is {shape}, but has {len(data)} bytes: damaged; save it again")
    array = np.frombuffer(data, dtype=dtype).reshape(shape, order="F" if by_columns else "C")
    return array.astype(dtype.newbyteorder("="), order="C")


def as_numbers(array: np.ndarray, label: str) -> np.ndarray:
    """An array as double floats; what is too large for them becomes infinite.

    Args:
        array: of any shape.
        label: names it in the message.

    Raises:
        InputError: it holds something else than real numbers.
    """
    if array.dtype.kind not in "fiub":
        raise InputError(f"{label} holds {_PLAIN.get(array.dtype.kind, array.dtype)}; give numbers")
    with np.errstate(over="ignore"):
        return array.astype(float)


def read_csv(path: str | os.PathLike[str], what: str, columns: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """A table of numbers with commas between them and the names of its columns, in any order, in the first line.

    Args:
        path: the file: UTF-8, or UTF-16 with a byte order mark.
        what: what it should be, for messages.
        columns: names of the columns, all of which it must have.

    Returns:
        The numbers, in the order of `columns`, an empty cell as NaN, and the line of the file that each row is on.
        Shapes (T, len(columns)) and (T,).

    Raises:
        InputError: it cannot be read as such; names the line.
    """
    with reading(path, what), open_file(path, what) as stream:
        content = stream.read()
        encoding = next((name for bom, name in _BOMS if content.startswith(bom)), "utf-8-sig")
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            raise InputError(f"{path}: is not text; a CSV starts with the line {','.join(columns)}") from None
        lines = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True)
        rows = [(lines.line_num, [cell.strip() for cell in row]) for row in lines]
        rows = [(number, row) for number, row in rows if any(row)]
        order = _header(path, rows[0][1] if rows else [], text, columns)
        table = np.empty((len(rows) - 1, len(columns)))
        for k, (number, row) in enumerate(rows[1:]):
            while len(row) > len(columns) and not row[-1]:
                row.pop()
            if len(row) != len(columns):
                raise InputError(f"{path}: line {number} has {len(row)} cells; give {len(columns)}, as in the header")
            table[k] = [_number(path, number, row[i]) for i in order]
        return table, np.array([number for number, _ in rows[1:]], dtype=int)


def _header(path: str | os.PathLike[str], found: list[str], text: str, columns: Sequence[str]) -> list[int]:
    """Where each of `columns` is among the names that were found."""
    while found and not found[-1]:
        found = found[:-1]
    found = [name.lower() for name in found]
    wanted = [name.lower() for name in columns]
    if sorted(found) == sorted(wanted):
        return [found.index(name) for name in wanted]
    first, _, rest = text.lstrip().partition("\n")
    for separator, name in ((";", "semicolons"), ("\t", "tabs")):
        if separator in first:
            commas = " and decimal commas" if "," in rest else ""
            raise InputError(
                f"{path}: has {name}{commas}, as some spreadsheets write them; save it as CSV with a comma between "
                f"columns and a point in numbers: {','.join(columns)}"
            )
    missing = [name for name, low in zip(columns, wanted, strict=True) if low not in found]
    raise InputError(
        f"{path}: the first line must be {','.join(columns)}"
        + (f"; it lacks {', '.join(missing)}" if missing else "; it has more than these, or one twice")
    )


def _number(path: str | os.PathLike[str], line: int, cell: str) -> float:
    if not cell:
        return np.nan
    try:
        if "_" in cell:  # Python's 1_000 is nobody's number
            raise ValueError
        return float(cell)
    except ValueError:
        hint = "; write a point, not a comma, in numbers" if "," in cell else ""
        raise InputError(f"{path}: line {line} has {cell[:40]!r}, which is not a number{hint}") from None
