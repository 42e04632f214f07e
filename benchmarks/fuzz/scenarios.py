"""Scenarios that somebody got wrong: each is read, or refused in one line, fast."""

from __future__ import annotations

import copy
import dataclasses
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from canal.errors import InputError
from diagrams.scenario import Scenario, load_scenario
from diagrams.station.lio_station import LioStation
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions
from models import SCENARIOS

BUILT = 0.15
"""Share of the scenarios that could be read whose scene and canal are built, too."""
JUNK: tuple[Any, ...] = (
    *(None, "", "text", "on", "é中", "x" * 3000, True, False, 0, -1, 1, 7, 10**30, 10**400, 1e-300, 1e308, -1e9),
    *(float("nan"), float("inf"), float("-inf"), [], {}, [1, 2], [0.1, 0.2, 0.3], [[1]], ["a", "b"], {"a": 1}, {1: 2}),
    *("1", "0.5", ".nan", "1e3", "0x10", "12:30:00", "2026-11-27", "../../etc/passwd", "/etc/passwd", "."),
    *("laundry_1.npz", "table", "soft", [float("nan")] * 3, [1e12] * 3, [0, 0, 0], [0, 0, 1], [1, 0, 0, 0]),
    *([0.3, 0.4, 0.5, 0, 0, 0, 0], [0.3, 0.4, 0.5, 1, 0, 0, 0]),
)
"""Values that end up in the wrong place."""
KEYS = [f.name for f in dataclasses.fields(Scenario)] + ["nonsense"]
"""Keys at the top that a scenario may or may not have."""
INNER = {
    f.name: [g.name for g in dataclasses.fields(value)]
    for f in dataclasses.fields(Scenario)
    if dataclasses.is_dataclass(value := getattr(Scenario(), f.name))
}
"""Keys below those."""


def case(seed: int) -> str:
    """Read one scenario with one to four faults in it; build what can be read, now and then."""
    rng = np.random.default_rng(seed)
    names = sorted(SCENARIOS.glob("*.yaml"))
    text = names[rng.integers(len(names))].read_text()
    if rng.random() < 0.8:
        data = yaml.safe_load(text)
        for _ in range(int(rng.integers(1, 5))):
            data = _spoiled(data, rng)
        text = yaml.safe_dump(data, allow_unicode=True)
        raw = text.encode()
    else:
        raw = _torn(text.encode(), rng)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.yaml"
        path.write_bytes(raw)
        scenario = load_scenario(path)
        if rng.random() > BUILT:
            return "read"
        try:
            prepare_canal(scenario, RunOptions(headless=True))
            LioStation(scenario, seed=seed)
        except InputError as error:
            raise InputError(f"building: {error}") from None
    return "read and built"


def _paths(data: Any, path: tuple = ()) -> list[tuple]:
    """Where there is something to spoil, as paths of keys and indices."""
    found = [path] if path else []
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        found += _paths(value, (*path, key))
    return found


def _spoiled(data: Any, rng: np.random.Generator) -> Any:
    """One fault more."""
    data = copy.deepcopy(data)
    if not isinstance(data, dict) or not (paths := _paths(data)):
        return data
    junk = copy.deepcopy(JUNK[rng.integers(len(JUNK))])
    kind = rng.integers(6)
    if kind == 0:
        key = KEYS[rng.integers(len(KEYS))]
        if key in INNER and rng.random() < 0.8:
            inner = INNER[key][rng.integers(len(INNER[key]))]
            held = data.get(key)
            data[key] = {**(held if isinstance(held, dict) else {}), inner: junk}
        else:
            data[key] = junk
        return data
    path = paths[rng.integers(len(paths))]
    holder = data
    for key in path[:-1]:
        holder = holder[key]
    last = path[-1]
    if kind == 1:
        del holder[last]
    elif kind == 2 and isinstance(holder, dict) and isinstance(last, str):
        holder[last + "x"] = holder.pop(last)
    elif kind == 3 and isinstance(holder, list):
        holder.append(copy.deepcopy(holder[last]))
    elif kind == 4 and isinstance(holder[last], float):
        holder[last] = float(holder[last] * rng.choice([-1, 1e-6, 1e3, 1e12, np.nan]))
    else:
        holder[last] = junk
    return data


def _torn(raw: bytes, rng: np.random.Generator) -> bytes:
    """Bytes lost, doubled and changed."""
    kind = rng.integers(4)
    at = int(rng.integers(len(raw)))
    if kind == 0:
        return raw[:at]
    if kind == 1:
        return raw[:at] + bytes(rng.integers(0, 256, 5).tolist()) + raw[at:]
    if kind == 2:
        return b"\xef\xbb\xbf" + raw
    return raw[:at] + raw[at : at + 200] + raw[at:]
