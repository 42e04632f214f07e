"""A joystick that was recorded: read from a file and checked. No Drake."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from canal.errors import InputError
from canal.navigation.joystick import JOYSTICK_SIZE, clean_joystick
from canal.reading import as_numbers, read_csv, read_npz

CSV_HEADER = ("t", "k_x", "k_y", "gripper", "reverse", "start", "stop")
"""First line of a CSV file, in any order."""
_WHAT = "a recorded joystick (.npz or .csv)"
_ROWS = ("time", "stick", "buttons")
_SAMPLES = ("joystick_time", "joystick", "joystick_in_charge")


@dataclass(frozen=True)
class JoystickRecording:
    """What a joystick did. A row holds from its time until the next row's; from the last row on the stick rests.

    Attributes:
        time: seconds, ascending. Shape (T,).
        joystick: joystick vectors (`canal.navigation.joystick`). Shape (T, 6).
        name: where it came from, for messages.
        person_in_charge: 1 where a person held the joystick, 0 where the simulated operator did: only the latter's stop
            ends a run. None: a person, all the time. Shape (T,).

    Raises:
        InputError: a shape, a value or an order that cannot be used.
    """

    time: np.ndarray
    joystick: np.ndarray
    name: str = "recording"
    person_in_charge: np.ndarray | None = None

    def __post_init__(self) -> None:
        time, joystick = np.asarray(self.time, dtype=float), np.asarray(self.joystick, dtype=float)
        if time.ndim != 1 or len(time) < 1:
            raise InputError(f"{self.name}: time has shape {time.shape}; give one number a row, at least one row")
        if joystick.shape != (len(time), JOYSTICK_SIZE):
            raise InputError(
                f"{self.name}: the joystick has shape {joystick.shape}; give ({len(time)}, {JOYSTICK_SIZE})"
            )
        person = np.ones(len(time)) if self.person_in_charge is None else np.asarray(self.person_in_charge, dtype=float)
        if person.shape != time.shape:
            raise InputError(f"{self.name}: person_in_charge has shape {person.shape}; give ({len(time)},)")
        for what, bad, remedy in (
            ("a time", ~np.isfinite(time), "give finite seconds"),
            ("a time", np.diff(time, prepend=-np.inf) <= 0, "give times that ascend"),
            ("a stick", ~(np.abs(joystick[:, :2]) <= 1).all(axis=1), "give k_x and k_y in [-1, 1]"),
            ("a button", ~np.isin(joystick[:, 2:], (0, 1)).all(axis=1), "give buttons as 0 or 1"),
            ("a person_in_charge", ~np.isin(person, (0, 1)), "give 0 or 1"),
        ):
            if bad.any():
                row = int(np.argmax(bad))
                raise InputError(f"{self.name}: row {row + 1} has {what} that cannot be used: {remedy}")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "joystick", np.array([clean_joystick(row) for row in joystick]))
        object.__setattr__(self, "person_in_charge", person)

    def at(self, time: float) -> np.ndarray:
        """The joystick vector at `time` [s]; centred and released before the first row and from the last row on."""
        row = self._row(time)
        if row < 0 or row == len(self.time) - 1:
            return np.zeros(JOYSTICK_SIZE)
        return self.joystick[row]

    def person_at(self, time: float) -> float:
        """1 if a person is in charge at `time` [s]; before the first row as in it, after the last as in that."""
        assert self.person_in_charge is not None
        return float(self.person_in_charge[max(self._row(time), 0)])

    def _row(self, time: float) -> int:
        return int(np.searchsorted(self.time, time, side="right")) - 1


def load_recording(path: str | Path) -> JoystickRecording:
    """Read a recorded joystick: a log (`--log`), or another `.npz` or CSV file.

    `.npz`: `time` (T,), `stick` (T, 2) and `buttons` (T, 4: gripper, reverse, start, stop), and if there is one
    `person_in_charge` (T,). A log's samples of the joystick, `joystick_time` (K,), `joystick` (K, 6) and
    `joystick_in_charge` (K,), are preferred: they are all there, whatever the control rate was. CSV: the header
    `t,k_x,k_y,gripper,reverse,start,stop`.

    Raises:
        InputError: the file is missing or cannot be used; says why.
    """
    path = Path(path)
    if path.suffix.lower() == ".csv":
        table, _ = read_csv(path, _WHAT, CSV_HEADER)
        return JoystickRecording(table[:, 0], table[:, 1:], name=str(path))
    arrays = {
        key: as_numbers(value, f"{path}: {key}")
        for key, value in read_npz(path, _WHAT, (*_ROWS, "person_in_charge", *_SAMPLES)).items()
    }
    if all(key in arrays for key in _SAMPLES):
        time, joystick, person = (arrays[key] for key in _SAMPLES)
        return JoystickRecording(time, joystick, str(path), person)
    missing = [key for key in _ROWS if key not in arrays]
    if missing:
        raise InputError(f"{path}: has no {', '.join(missing)}; give a log as --log writes it, or {_WHAT}")
    time, stick, buttons = (arrays[key] for key in _ROWS)
    if stick.shape != (time.size, 2) or buttons.shape != (time.size, JOYSTICK_SIZE - 2):
        raise InputError(f"{path}: stick {stick.shape} and buttons {buttons.shape}; give (T, 2) and (T, 4)")
    return JoystickRecording(time, np.hstack([stick, buttons]), str(path), arrays.get("person_in_charge"))
