"""A joystick that was recorded: read from a file and checked. No Drake."""

from __future__ import annotations

import csv
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from canal.errors import InputError
from canal.joystick import JOYSTICK_SIZE

CSV_HEADER = ("t", "k_x", "k_y", "gripper", "reverse", "start", "stop")
"""First line of a CSV file."""


@dataclass(frozen=True)
class JoystickRecording:
    """What a joystick did. A row holds from its time until the next row's; from the last row on the stick rests.

    Attributes:
        time: seconds, ascending. Shape (T,).
        joystick: joystick vectors (`canal.joystick`). Shape (T, 6).
        name: where it came from, for messages.

    Raises:
        InputError: a shape, a value or an order that cannot be used.
    """

    time: np.ndarray
    joystick: np.ndarray
    name: str = "recording"

    def __post_init__(self) -> None:
        time, joystick = np.asarray(self.time, dtype=float), np.asarray(self.joystick, dtype=float)
        if time.ndim != 1 or len(time) < 1:
            raise InputError(f"{self.name}: time has shape {time.shape}; give one number a row, at least one row")
        if joystick.shape != (len(time), JOYSTICK_SIZE):
            raise InputError(
                f"{self.name}: the joystick has shape {joystick.shape}; give ({len(time)}, {JOYSTICK_SIZE})"
            )
        for what, bad, remedy in (
            ("a time", ~np.isfinite(time), "give finite seconds"),
            ("a time", np.diff(time, prepend=-np.inf) <= 0, "give times that ascend"),
            ("a stick", ~(np.abs(joystick[:, :2]) <= 1).all(axis=1), "give k_x and k_y in [-1, 1]"),
            ("a button", ~np.isin(joystick[:, 2:], (0, 1)).all(axis=1), "give buttons as 0 or 1"),
        ):
            if bad.any():
                row = int(np.argmax(bad))
                raise InputError(f"{self.name}: row {row + 1} has {what} that cannot be used: {remedy}")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "joystick", joystick)

    def at(self, time: float) -> np.ndarray:
        """The joystick vector at `time` [s]; centred and released before the first row and from the last row on."""
        row = int(np.searchsorted(self.time, time, side="right")) - 1
        if row < 0 or row == len(self.time) - 1:
            return np.zeros(JOYSTICK_SIZE)
        return self.joystick[row]


def load_recording(path: str | Path) -> JoystickRecording:
    """Read a recorded joystick: a log (`--log`), or another `.npz` or CSV file.

    `.npz`: `time` (T,), `stick` (T, 2) and `buttons` (T, 4: gripper, reverse, start, stop). CSV: the header
    `t,k_x,k_y,gripper,reverse,start,stop`.

    Raises:
        InputError: the file is missing or cannot be used; says why.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: there is no such file; give a recorded joystick (.npz or .csv)")
    time, joystick = _read_npz(path) if path.suffix == ".npz" else _read_csv(path)
    return JoystickRecording(time, joystick, name=str(path))


def _read_npz(path: Path) -> tuple[np.ndarray, np.ndarray]:
    try:
        with np.load(path, allow_pickle=False) as file:
            missing = [key for key in ("time", "stick", "buttons") if key not in file]
            if missing:
                raise InputError(f"{path}: no {', '.join(missing)} in it; give time, stick and buttons")
            time, stick, buttons = (np.asarray(file[key], dtype=float) for key in ("time", "stick", "buttons"))
    except InputError:
        raise
    except (ValueError, TypeError, OSError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: not an .npz file of numbers; give one as --log writes it") from error
    if stick.shape != (len(np.atleast_1d(time)), 2) or buttons.shape != (len(stick), JOYSTICK_SIZE - 2):
        raise InputError(f"{path}: stick {stick.shape} and buttons {buttons.shape}; give (T, 2) and (T, 4)")
    return time, np.hstack([stick, buttons])


def _read_csv(path: Path) -> tuple[np.ndarray, np.ndarray]:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = [[cell.strip() for cell in row] for row in csv.reader(file) if row]
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: not a CSV file; give one, or an .npz") from error
    if not rows or tuple(rows[0]) != CSV_HEADER:
        raise InputError(f"{path}: the first line is not {','.join(CSV_HEADER)}; put it there")
    try:
        values = np.array([[float(cell) for cell in row] for row in rows[1:]])
    except ValueError as error:
        raise InputError(f"{path}: a cell is not a number, or a row is shorter than the header: mend it") from error
    if values.ndim != 2 or values.shape[1] != len(CSV_HEADER):
        raise InputError(f"{path}: {len(rows) - 1} rows, not all of {len(CSV_HEADER)} numbers; give at least one row")
    return values[:, 0], values[:, 1:]
