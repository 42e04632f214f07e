"""What a log says of the run that it is of, and that run again: `--operator LOG`."""

from __future__ import annotations

import json
import os
from copy import deepcopy
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field, TypeAdapter

from canal.errors import InputError
from canal.options import options, read_options
from canal.reading import read_npz
from canal.surface import CanalSurface
from canal.surface_file import KEYS, canal_arrays, canal_of
from diagrams.scenario import RENAMED, Scenario
from diagrams.scene.world import check_world
from geosacs_drake.results.summary import RunResult
from geosacs_drake.run_options import PEOPLE, RunOptions
from geosacs_drake.simulate import INTERRUPTED

CANAL = "canal_"
"""Before each key of a canal file that is in a log."""
_WHAT = "a log as --log writes it"


@options("metadata")
class Metadata:
    """What a log says of its run, as JSON in its array `metadata`."""

    version: str
    """Of the program."""
    task: str
    scenario_name: str
    """As it was named: a file, or one that ships."""
    scenario: Scenario
    """All of it, as it was run."""
    items_kind: str
    operator: str
    seed: Annotated[int, Field(ge=0)]
    duration: Annotated[float, Field(gt=0)]
    """Longest simulated time [s]; of a run that was interrupted, until then."""
    options: dict[str, object]
    """Of the command."""

    def to_json(self) -> str:
        """As text that `canal.options.read_options` takes, once it is no JSON any more."""
        return TypeAdapter(Metadata).dump_json(self).decode()

    @property
    def base(self) -> str:
        """The scenario that was named, or the task whose own was taken."""
        return str(self.options.get("scenario") or self.task)


@dataclass(frozen=True)
class Origin:
    """What a run was made from."""

    metadata: Metadata
    """What the log says of its run."""
    canal: CanalSurface
    """The canal that the run travelled."""

    def arrays(self) -> dict[str, np.ndarray]:
        """For a log: numbers and text, nothing pickled."""
        return {"metadata": np.array(self.metadata.to_json())} | {
            CANAL + key: a for key, a in canal_arrays(self.canal).items()
        }


def make_origin(
    options: RunOptions, *, result: RunResult, scenario: Scenario, canal: CanalSurface, duration: float
) -> Origin:
    """What a run was made from, for its log.

    Args:
        options: of the command.
        result: of the run.
        scenario: as it was run.
        canal: as it was travelled.
        duration: longest simulated time [s].
    """
    time = result.signals["time"]
    cut = bool(result.failure) or result.reason == INTERRUPTED
    metadata = Metadata(
        version=version("geosacs-drake"),
        task=result.task,
        scenario_name=result.scenario,
        scenario=replace(deepcopy(scenario), folder=os.path.abspath(scenario.folder)),  # for a replay from elsewhere
        items_kind=result.items_kind,
        operator=result.operator,
        seed=result.seed,
        duration=float(time[-1]) if cut and time.size and time[-1] > 0 else duration,
        options=TypeAdapter(RunOptions).dump_python(options, mode="json"),
    )
    return Origin(metadata, canal)


def load_origin(operator: str) -> Origin | None:
    """What the run of a log was made from.

    Args:
        operator: of the command line: maybe a log.

    Returns:
        None where it is no log, or one that says nothing of its run: a recorded joystick, and no more.

    Raises:
        InputError: the file cannot be read, or what it says of its run cannot be used.
    """
    if operator in ("simulated", *PEOPLE) or Path(operator).suffix.lower() == ".csv":
        return None
    arrays = read_npz(operator, _WHAT, ("metadata", *(CANAL + key for key in KEYS)))
    text = arrays.pop("metadata", None)
    if text is None:
        return None
    if text.shape != () or text.dtype.kind != "U":
        raise InputError(f"{operator}: its metadata is no text; give {_WHAT}")
    try:
        metadata = read_options(Metadata, json.loads(str(text[()])), RENAMED)
    except (ValueError, RecursionError) as error:
        reason = error if isinstance(error, InputError) else "its metadata is no JSON"
        raise InputError(f"{operator}: {reason}; give {_WHAT}") from None
    try:
        check_world(metadata.scenario)
    except InputError as error:
        raise InputError(f"{operator}: {error}") from None
    return Origin(metadata, canal_of(operator, {key.removeprefix(CANAL): array for key, array in arrays.items()}))


def differences(origin: Origin, *, seed: int, scenario: Scenario, canal: CanalSurface) -> list[str]:
    """In what a replay is another run than the one of its log, in words.

    Args:
        origin: of the log.
        seed: that will be used.
        scenario: that will be run.
        canal: that will be travelled.
    """
    was = origin.metadata
    others = []
    if seed != was.seed:
        others.append(f"seed {seed} instead of {was.seed}")
    if replace(scenario, folder="") != replace(was.scenario, folder=""):
        kinds = [[item.kind for item in s.items] for s in (scenario, was.scenario)]
        others.append("another scenario" if kinds[0] == kinds[1] else f"{kinds[0][0]} items")
    mine, its = canal_arrays(canal), canal_arrays(origin.canal)
    if any(key not in its or not np.array_equal(mine[key], its[key]) for key in mine):
        others.append("another canal")
    if was.version != version("geosacs-drake"):
        others.append(f"version {version('geosacs-drake')} of the program instead of {was.version}")
    return others
