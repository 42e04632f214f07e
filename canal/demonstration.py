"""Demonstrations: timed poses of the tool centre point, read, checked and written."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from canal.errors import InputError
from canal.files import read_npz, write_and_rename, write_npz

SAMPLE_RATE_HZ = 20.0  # the paper records at 20 Hz; assumed where a file has no time stamps
MIN_SAMPLES = 4
CSV_HEADER = "t,x,y,z,qw,qx,qy,qz"
LARGEST_COORDINATE_M = 100.0  # beyond this the file is in millimetres, or broken


@dataclass(frozen=True, eq=False)
class Demonstration:
    """One kinesthetic demonstration: N ≥ 4 timed poses of the TCP in the robot's base frame B.

    Attributes:
        position: p_BT of each sample, [m]. Shape (N, 3).
        orientation: unit quaternions q_BT, (w, x, y, z). Shape (N, 4). Normalised on construction.
        time: strictly increasing time stamps, [s]. Shape (N,). Built at 20 Hz when None is given.
        name: where it came from, for messages.

    Raises:
        InputError: a shape, a length or a value cannot be used.
    """

    position: np.ndarray
    orientation: np.ndarray
    time: np.ndarray = None  # type: ignore[assignment]
    name: str = "demonstration"

    def __post_init__(self):
        position = _as_floats(self.position, "position", self.name)
        orientation = _as_floats(self.orientation, "orientation", self.name)
        if position.ndim != 2 or position.shape[1] != 3:
            raise InputError(f"{self.name}: position has shape {position.shape}; it must be (N, 3) in metres")
        n = len(position)
        if orientation.shape != (n, 4):
            raise InputError(
                f"{self.name}: orientation has shape {orientation.shape}; it must be ({n}, 4), one quaternion "
                "w, x, y, z for each position"
            )
        if n < MIN_SAMPLES:
            raise InputError(f"{self.name}: {n} samples; a demonstration needs at least {MIN_SAMPLES}")
        time = np.arange(n) / SAMPLE_RATE_HZ if self.time is None else _as_floats(self.time, "time", self.name)
        if time.shape != (n,):
            raise InputError(f"{self.name}: time has shape {time.shape}; it must be ({n},), one for each position")
        for label, values in (("position", position), ("orientation", orientation), ("time", time)):
            bad = np.flatnonzero(~np.isfinite(values).reshape(n, -1).all(axis=1))
            if bad.size:
                raise InputError(
                    f"{self.name}: {label} is not finite at {bad.size} of {n} samples, first at {bad[0]}; "
                    "remove those samples"
                )
        if np.abs(position).max() > LARGEST_COORDINATE_M:
            raise InputError(
                f"{self.name}: position reaches {np.abs(position).max():.0f} m, more than "
                f"{LARGEST_COORDINATE_M:.0f}; give it in metres"
            )
        steps = np.diff(time)
        if (steps <= 0).any():
            raise InputError(
                f"{self.name}: time does not increase at sample {int(np.argmax(steps <= 0)) + 1}; sort the "
                "samples, or leave time out for 20 Hz"
            )
        norm = np.linalg.norm(orientation, axis=1)
        if norm.min() < 0.5 or norm.max() > 2.0:
            worst = int(np.argmax(np.abs(np.log(np.maximum(norm, 1e-300)))))
            raise InputError(
                f"{self.name}: orientation {worst} has norm {norm[worst]:.3g}; quaternions must be unit, w, x, y, z"
            )
        for label, values in (
            ("position", position),
            ("orientation", orientation / norm[:, None]),
            ("time", time),
        ):
            values.setflags(write=False)
            object.__setattr__(self, label, values)

    def __len__(self) -> int:
        return len(self.position)

    @property
    def duration(self) -> float:
        """From the first sample to the last, [s]."""
        return float(self.time[-1] - self.time[0])


def _as_floats(values, label: str, name: str) -> np.ndarray:
    try:
        return np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name}: {label} is not an array of numbers") from None


def load_demonstration(path: str | os.PathLike) -> Demonstration:
    """Read a demonstration from `.npz` (`position`, `orientation`, optionally `time`) or `.csv`.

    A CSV has the header `t,x,y,z,qw,qx,qy,qz`. Nothing is ever unpickled.

    Raises:
        InputError: the file is missing, or is not such a file; the message says what to mend.
    """
    path = Path(path)
    if not path.exists():
        raise InputError(f"{path}: no such file; give a demonstration as .npz or .csv")
    if path.is_dir():
        raise InputError(f"{path}: is a folder; give a demonstration as .npz or .csv")
    if path.stat().st_size == 0:
        raise InputError(f"{path}: the file is empty; record the demonstration again")
    return _load_csv(path) if path.suffix.lower() == ".csv" else _load_npz(path)


def _load_npz(path: Path) -> Demonstration:
    arrays = read_npz(path, "a demonstration")
    for key in ("position", "orientation"):
        if key not in arrays:
            found = ", ".join(sorted(arrays)) or "nothing"
            raise InputError(f"{path}: has no array '{key}' (found: {found}); it needs position and orientation")
    return Demonstration(arrays["position"], arrays["orientation"], arrays.get("time"), path.name)  # type: ignore[arg-type]


def _load_csv(path: Path) -> Demonstration:
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not text; a CSV starts with the header {CSV_HEADER}") from None
    if not lines or lines[0].replace(" ", "").lower() != CSV_HEADER:
        raise InputError(f"{path}: the first line must be {CSV_HEADER}")
    rows = [line for line in lines[1:] if line.strip()]
    try:
        table = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    except ValueError:
        raise InputError(f"{path}: a row is not 8 numbers; the columns are {CSV_HEADER}") from None
    if table.ndim != 2 or table.shape[1] != 8:
        raise InputError(f"{path}: found {len(rows)} rows of {table.shape[1:]} columns; they must be {CSV_HEADER}")
    return Demonstration(table[:, 1:4], table[:, 4:8], table[:, 0], name=path.name)


def save_demonstration(path: str | os.PathLike, demonstration: Demonstration) -> None:
    """Write a demonstration as `.npz` (or `.csv`, by the suffix), to a temporary file that is then renamed."""
    path = Path(path)
    d = demonstration
    if path.suffix.lower() == ".csv":
        table = np.column_stack([d.time, d.position, d.orientation])
        body = "\n".join([CSV_HEADER, *(",".join(repr(float(v)) for v in row) for row in table), ""])
        write_and_rename(path, lambda stream: stream.write(body.encode()))
    else:
        write_npz(path, position=d.position, orientation=d.orientation, time=d.time)
