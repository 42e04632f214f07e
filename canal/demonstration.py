"""Demonstrations: timed poses of the tool centre point, read, checked and written."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from canal.errors import InputError
from canal.files import write_and_rename, write_npz
from canal.options import options
from canal.reading import as_numbers, read_csv, read_npz

SAMPLE_RATE_HZ = 20.0  # the paper records at 20 Hz; assumed where a file has no time stamps
MIN_SAMPLES = 4
"""Fewest samples of a demonstration: a cubic has four coefficients."""
CSV_HEADER = "t,x,y,z,qw,qx,qy,qz"
"""First line of a CSV file."""
LARGEST_COORDINATE_M = 10.0  # from the robot's base; what an arm reaches is beyond this in centimetres or inches
SMALLEST_STEP_S = 1e-5  # no tracker is faster than 100 kHz: what is closer in time is broken, or another unit
SHORTEST_QUATERNION, LONGEST_QUATERNION = 0.5, 2.0  # rounding makes 0.999, a broken sample 0
METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254}
SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
"""Units that a recording may be in, in metres and in seconds."""
_WHAT = "a demonstration (.npz or .csv)"


@options("recording", frozen=True)
class RecordingFormat:
    """How a recording holds its numbers, where it is not as ours.

    Attributes:
        units: of positions: m, cm, mm or in.
        time_unit: of time stamps: s, ms, us or ns.
        quaternion_order: wxyz, or xyzw as in ROS and scipy; a CSV names its columns instead.
        drop_bad_samples: leave out samples that are not finite, without orientation or out of time, instead of
            refusing the file.
    """

    units: Literal["m", "cm", "mm", "in"] = "m"
    time_unit: Literal["s", "ms", "us", "ns"] = "s"
    quaternion_order: Literal["wxyz", "xyzw"] = "wxyz"
    drop_bad_samples: bool = False


AS_OURS = RecordingFormat()
"""Metres, seconds, w, x, y, z, and every sample is used."""


@dataclass(frozen=True, eq=False)
class Demonstration:
    """One kinesthetic demonstration: N ≥ 4 timed poses of the TCP in the robot's base frame B.

    Attributes:
        position: p_BT of each sample, [m]. Shape (N, 3).
        orientation: unit quaternions q_BT, (w, x, y, z). Shape (N, 4). Normalised on construction.
        time: strictly increasing time stamps, [s]. Shape (N,). Built at 20 Hz when None is given.
        name: where it came from, for messages.
        dropped: how many samples of the recording were left out as unusable.
        lines: of its file, one a sample, for messages; None where it has none. Shape (N,).

    Raises:
        InputError: a shape, a length or a value cannot be used.
    """

    position: np.ndarray
    orientation: np.ndarray
    time: np.ndarray = None  # type: ignore[assignment]
    name: str = "demonstration"
    dropped: int = 0
    lines: np.ndarray | None = None

    def __post_init__(self) -> None:
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
                    f"{self.name}: {label} is not finite at {bad.size} of {n} samples, first at {self._row(bad[0])}; "
                    "remove those samples (learn --drop-bad-samples)"
                )
        if np.abs(position).max() > LARGEST_COORDINATE_M:
            far = int(np.argmax(np.abs(position).max(axis=1)))
            raise InputError(
                f"{self.name}: position reaches {np.abs(position).max():.4g} m at {self._row(far)}, more than "
                f"{LARGEST_COORDINATE_M:.0f}; give metres from the robot's base (learn --units cm, mm or in)"
            )
        steps = np.diff(time)
        if (steps <= 0).any():
            raise InputError(
                f"{self.name}: time does not increase at {self._row(int(np.argmax(steps <= 0)) + 1)}; sort the "
                "samples, leave time out for 20 Hz, or drop them (learn --drop-bad-samples)"
            )
        if steps.min() < SMALLEST_STEP_S:
            raise InputError(
                f"{self.name}: time grows by {steps.min():.2g} s only at {self._row(int(np.argmin(steps)) + 1)} (at "
                f"least {SMALLEST_STEP_S:g}); give seconds, or leave time out for 20 Hz"
            )
        norm = np.linalg.norm(orientation, axis=1)
        if norm.min() < SHORTEST_QUATERNION or norm.max() > LONGEST_QUATERNION:
            worst = int(np.argmax(np.abs(np.log(np.maximum(norm, 1e-300)))))
            raise InputError(
                f"{self.name}: the orientation at {self._row(worst)} has norm {norm[worst]:.3g}; quaternions must be "
                "unit, w, x, y, z (learn --drop-bad-samples leaves such samples out)"
            )
        for label, values in (
            ("position", position),
            ("orientation", orientation / norm[:, None]),
            ("time", time),
        ):
            values.setflags(write=False)
            object.__setattr__(self, label, values)

    def _row(self, sample: int) -> str:
        """A sample as a person finds it."""
        return f"sample {sample}" + ("" if self.lines is None else f" (line {self.lines[sample]})")

    def __len__(self) -> int:
        return len(self.position)

    @property
    def duration(self) -> float:
        """From the first sample to the last, [s]."""
        return float(self.time[-1] - self.time[0])


def _as_floats(values: ArrayLike, label: str, name: str) -> np.ndarray:
    try:
        return np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name}: {label} is not an array of numbers") from None


def load_demonstration(path: str | os.PathLike[str], recorded: RecordingFormat = AS_OURS) -> Demonstration:
    """Read a demonstration from `.npz` (`position`, `orientation`, optionally `time`) or `.csv`.

    A CSV has the header `t,x,y,z,qw,qx,qy,qz`, in any order. Nothing is ever unpickled.

    Args:
        path: the file.
        recorded: units and order in which it holds its numbers, and what to do with samples that cannot be used.

    Raises:
        InputError: the file is missing, or is not such a file; the message says what to mend.
    """
    path = Path(path)
    name = path.name
    if path.suffix.lower() == ".csv":
        table, lines = read_csv(path, _WHAT, CSV_HEADER.split(","))
        arrays = {"time": table[:, 0], "position": table[:, 1:4], "orientation": table[:, 4:]}
    else:
        arrays, lines = read_npz(path, _WHAT, ("position", "orientation", "time")), None
        for key in ("position", "orientation"):
            if key not in arrays:
                found = ", ".join(sorted(arrays)) or "neither"
                raise InputError(f"{path}: has no array '{key}' (found: {found}); it needs position and orientation")
        arrays = {key: as_numbers(array, f"{path}: {key}") for key, array in arrays.items()}
        if recorded.quaternion_order == "xyzw" and arrays["orientation"].ndim == 2:
            arrays["orientation"] = np.roll(arrays["orientation"], 1, axis=1)
    position, orientation, time = arrays["position"], arrays["orientation"], arrays.get("time")
    position = position * METRES[recorded.units]
    if time is not None and time.size and recorded.time_unit != "s":
        time = (time - time.flat[0]) * SECONDS[recorded.time_unit]
    dropped, timed = 0, time
    if recorded.drop_bad_samples:
        position, orientation, timed, dropped = _without_bad_samples(position, orientation, time, name)
        lines = None
    return Demonstration(position, orientation, timed, name, dropped, lines)  # type: ignore[arg-type]


def _without_bad_samples(
    position: np.ndarray, orientation: np.ndarray, time: np.ndarray | None, name: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None, int]:
    """The samples that can be used, timed, and how many were dropped; arrays of odd shapes are left to be refused."""
    n = len(position) if position.ndim == 2 else 0
    clock = np.arange(n) / SAMPLE_RATE_HZ if time is None else time
    if orientation.shape != (n, 4) or clock.shape != (n,):
        return position, orientation, time, 0
    norm = np.linalg.norm(orientation, axis=1)
    good = np.isfinite(position).all(axis=1) & np.isfinite(norm) & np.isfinite(clock)
    good &= (norm > SHORTEST_QUATERNION) & (norm < LONGEST_QUATERNION)
    far = ~(np.abs(position) <= LARGEST_COORDINATE_M).all(axis=1)
    if np.sum(far & good) < 0.5 * np.sum(good):  # where most are far away it is the unit that is wrong
        good &= ~far
    before = np.concatenate([[-np.inf], np.maximum.accumulate(np.where(good, clock, -np.inf))[:-1]])
    good &= clock > before + SMALLEST_STEP_S
    if n and good.sum() < MIN_SAMPLES:
        raise InputError(f"{name}: {good.sum()} of {n} samples can be used; give at least {MIN_SAMPLES} good ones")
    return position[good], orientation[good], clock[good], int(n - good.sum())


def save_demonstration(path: str | os.PathLike[str], demonstration: Demonstration) -> None:
    """Write a demonstration as `.npz` (or `.csv`, by the suffix), to a temporary file that is then renamed.

    Args:
        path: of the file; its ending says which kind.
        demonstration: what is written.
    """
    path = Path(path)
    d = demonstration
    if path.suffix.lower() == ".csv":
        table = np.column_stack([d.time, d.position, d.orientation])
        body = "\n".join([CSV_HEADER, *(",".join(repr(float(v)) for v in row) for row in table), ""])
        write_and_rename(path, lambda stream: stream.write(body.encode()))
    else:
        write_npz(path, position=d.position, orientation=d.orientation, time=d.time)
