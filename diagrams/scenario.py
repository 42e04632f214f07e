"""Scenarios: what stands where, what is to be done; typed, read from YAML."""

from dataclasses import field
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator
from pydrake.common.yaml import yaml_load
from yaml import YAMLError

from canal.errors import InputError
from canal.learning_options import LearningOptions
from canal.navigation import NavigationOptions
from canal.options import Angle, Coordinate, options, read_options, short
from canal.support_planes import SupportPlane
from diagrams.ik.options import IkOptions
from diagrams.monitor import MonitorOptions
from diagrams.operator.options import OperatorOptions
from diagrams.scene.world import Kind, World, check_world
from models import MODELS, SCENARIOS


def _pose(numbers: list[float]) -> list[float]:
    if len(numbers) not in (0, 3, 7):
        raise InputError("give a position (3 numbers), or a position and a quaternion w, x, y, z (7)")
    if len(numbers) == 7 and not 0.5 < sum(v * v for v in numbers[3:]) < 2:
        raise InputError("give a unit quaternion w, x, y, z")
    return numbers


@options()
class Retarget:
    """Where pick and place are now, if the task has moved since it was shown: poses of the TCP in B.

    Each a position [m], or a position and a quaternion (w, x, y, z); empty keeps the canal's own.
    """

    pick: Annotated[list[Coordinate], AfterValidator(_pose)] = field(default_factory=list)
    place: Annotated[list[Coordinate], AfterValidator(_pose)] = field(default_factory=list)
    pick_yaw_deg: Angle = 0.0
    """By how much the orientation is turned about the vertical."""
    place_yaw_deg: Angle = 0.0
    """Likewise at place."""


@options()
class Scenario(World):
    """A task, and all that it needs."""

    task: Literal["laundry", "relocation"] = "laundry"
    description: str = ""
    demonstrations: list[str] = field(default_factory=list)
    """Files of models/demonstrations, or paths beside the scenario."""
    canal: str | None = None
    """A learned canal instead of demonstrations."""
    retarget: Retarget = field(default_factory=Retarget)
    support_planes: list[SupportPlane] = field(default_factory=list)
    """Tables, walls and doors, in B: normal · p ≥ offset."""
    learning: LearningOptions = field(default_factory=LearningOptions)
    navigation: NavigationOptions = field(default_factory=NavigationOptions)
    ik: IkOptions = field(default_factory=IkOptions)
    operator: OperatorOptions = field(default_factory=OperatorOptions)
    mapping: Literal["axes", "seat", "view"] | None = None
    """What the stick's right and up are: the correction axes (the paper), or right and up as seen from the seat or by
    the camera. None: by the camera in the console, else the axes."""
    seat: Literal["front", "left", "right", "behind"] = "front"
    """Where the person sits, seen from the robot."""
    monitor: MonitorOptions = field(default_factory=MonitorOptions)
    """What counts as placed, and when a force is too large."""


RENAMED = {"things": "fixtures", "soft_start": "deformable_start", "keep_clear": "collision_avoidance"}
"""Keys of earlier versions, and what they are called now."""


def shipped_scenarios() -> list[str]:
    """Names of the scenarios that ship."""
    return sorted(p.stem for p in SCENARIOS.glob("*.yaml"))


def load_scenario(name: str | Path) -> Scenario:
    """Read a scenario: a file, or the name of one that ships.

    Raises:
        InputError: it does not exist, or a key, a type, a value or a name in it cannot be used.
    """
    path = Path(name)
    if not path.is_file():
        path = SCENARIOS / f"{name}.yaml"
    if not path.is_file():
        known = ", ".join(shipped_scenarios())
        raise InputError(f"scenario {short(str(name))} does not exist; give a YAML file or one of {known}")
    try:
        scenario = read_options(Scenario, yaml_load(filename=str(path)), RENAMED)
        scenario.folder = str(path.parent)
        check_world(scenario)
        _check_canal(scenario)
    except InputError as error:
        raise InputError(f"scenario {path.name}: {error}") from None
    except (YAMLError, RuntimeError, ValueError, TypeError, OSError) as error:
        words = " ".join(str(error).split())
        raise InputError(f"scenario {path.name}: {words}; see models/scenarios for what can be said") from None
    return scenario


def with_items(scenario: Scenario, kind: Kind) -> Scenario:
    """Make all clothes soft, or rigid (the items of a relocation are rigid, always).

    Args:
        scenario: changed in place.
        kind: soft or rigid.
    """
    if scenario.task == "laundry":
        for item in scenario.items:
            item.kind = kind
    return scenario


def _check_canal(scenario: Scenario) -> None:
    if scenario.canal is None and not scenario.demonstrations:
        raise InputError("there is neither canal nor demonstrations; give one of them")
    for name in (*scenario.demonstrations, *([scenario.canal] if scenario.canal is not None else [])):
        scenario.resolve(name, MODELS / "demonstrations")
