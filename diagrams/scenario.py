"""Scenarios: what stands where, what is to be done; typed, read from YAML."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

from pydrake.common.yaml import yaml_load, yaml_load_typed
from yaml import YAMLError

from canal.errors import InputError
from canal.learning import LearningOptions
from canal.navigation import NavigationOptions
from diagrams.ik_options import IkOptions
from diagrams.monitor import MonitorOptions
from diagrams.operator_options import OperatorOptions
from diagrams.yaml_kinds import check_kinds
from models import MODELS, SCENARIOS

TASKS = ("laundry", "relocation")
KINDS = ("soft", "rigid")


@dataclass
class Robot:
    """Where the base B stands in W."""

    position: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    """p_WB [m]."""
    yaw_deg: float = 0.0


@dataclass
class Thing:
    """A piece of the surroundings, welded to the world."""

    name: str = ""
    """Names the contact pair `lio-NAME`; several things may share a name, and count as one."""
    model: str = ""
    """An SDFormat file of models/world, without its ending, or a path beside the scenario."""
    position: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Of the model's origin in W [m]."""
    yaw_deg: float = 0.0


@dataclass
class Region:
    """Where a thing may lie: a rectangle on a horizontal surface."""

    frame: str = ""
    """The thing in whose frame the rectangle is given, so that it goes where the thing goes; empty: in W."""
    center: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Its middle, z on the surface [m]."""
    half_widths: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """Half its extent along x and y of the frame [m]."""
    yaw_deg: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """Least and largest turn about z."""


@dataclass
class Item:
    """A thing to carry."""

    name: str = ""
    model: str = ""
    """An SDFormat file of models/items, without its ending; for soft ones the kind of cloth, of the same name."""
    kind: str = "rigid"
    """`rigid` or `soft`."""
    start: Region = field(default_factory=Region)
    soft_start: Region | None = None
    """The same for the soft one, which is longer; None: `start`."""
    goal: Region | None = None
    """Where its mark lies (relocation); without one it belongs into the drum."""
    upright: bool = False
    """Whether it must stand upright on its mark."""


@dataclass
class Drum:
    """Where the laundry belongs."""

    center: list[float] = field(default_factory=lambda: [0.0, 0.85, 0.55])
    """Centre of the door's plane in W [m]."""
    inward: list[float] = field(default_factory=lambda: [0.0, 1.0, 0.0])
    """The drum's axis, into the machine: along an axis of W, as the things' bounds are. Turn the robot instead."""
    depth: float = 0.34
    radius: float = 0.25


@dataclass
class Contact:
    """How contact is computed."""

    time_step: float = 0.004
    """Of the plant [s]. With 5 ms what topples sinks into the drum by up to 5.1 mm instead of 4.6, a rigid piece in 60
    slips by 3 mm in a carry instead of at most 2, and a run takes a sixth less time. With 10 ms they slip by 5 mm."""
    approximation: str | None = None
    """None: `lagged` where there is cloth, else `sap`, with which rigid pieces creep half as far in the hand."""
    model: str = "hydroelastic_with_fallback"
    stiction_tolerance: float = 2e-4
    """Speed [m/s] below which friction holds; what is held creeps at up to this. In a carry of 20 s cloth slips by 1 to
    2 mm; half of it takes a tenth more time; with Drake's default of 1e-3 a held piece creeps 2.5 times as far. `sap`
    does not ask for it."""

    def for_items(self, soft: bool) -> "Contact":
        """With what fits cloth, or rigid things, where nothing is said."""
        return replace(self, approximation=self.approximation or ("lagged" if soft else "sap"))


@dataclass
class Plane:
    """A support plane in B: normal · p ≥ offset."""

    normal: list[float] = field(default_factory=lambda: [0.0, 0.0, 1.0])
    offset: float = 0.0


@dataclass
class Retarget:
    """Where pick and place are now, if the task has moved since it was shown: poses of the TCP in B.

    Each a position [m], or a position and a quaternion (w, x, y, z); empty keeps the canal's own.
    """

    pick: list[float] = field(default_factory=list)
    place: list[float] = field(default_factory=list)
    pick_yaw_deg: float = 0.0
    """By how much the orientation is turned about the vertical."""
    place_yaw_deg: float = 0.0


@dataclass
class Scenario:
    """A task, and all that it needs."""

    task: str = "laundry"
    """`laundry` or `relocation`."""
    description: str = ""
    robot: Robot = field(default_factory=Robot)
    things: list[Thing] = field(default_factory=list)
    items: list[Item] = field(default_factory=list)
    item_spacing: float = 0.13
    """Least distance between the middles of two items, and of two marks, at the start [m]: the open fingers fit."""
    drum: Drum | None = None
    contact: Contact = field(default_factory=Contact)
    demonstrations: list[str] = field(default_factory=list)
    """Files of models/demonstrations, or paths beside the scenario."""
    canal: str | None = None
    """A learned canal instead of demonstrations."""
    retarget: Retarget = field(default_factory=Retarget)
    support_planes: list[Plane] = field(default_factory=list)
    learning: dict[str, float] = field(default_factory=dict)
    """Fields of canal.learning.LearningOptions that differ from their defaults."""
    navigation: NavigationOptions = field(default_factory=NavigationOptions)
    ik: IkOptions = field(default_factory=IkOptions)
    operator: OperatorOptions = field(default_factory=OperatorOptions)
    monitor: MonitorOptions = field(default_factory=MonitorOptions)
    control_rate_hz: float = 50.0
    """Of navigator, IK and monitor (paper: 20 Hz); at 100 Hz the tool keeps within 3.6 mm instead of 5.5, and a run
    takes a third longer."""
    folder: str = ""
    """Where relative paths start; set on loading."""

    def resolve(self, name: str, folder: Path, suffix: str = "") -> Path:
        """The file that a name means: beside the scenario if it is there, else in the given folder of models/.

        Raises:
            InputError: there is no such file; names those that there are.
        """
        beside = Path(self.folder) / name
        shipped = folder / f"{name}{suffix}"
        for path in (beside, shipped):
            if path.is_file():
                return path
        there = ", ".join(sorted(p.stem if suffix else p.name for p in folder.glob(f"*{suffix or '.npz'}")))
        raise InputError(f"{name!r} does not exist; give a file or one of {there}")


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
        raise InputError(f"scenario {str(name)!r} does not exist; give a YAML file or one of {known}")
    try:
        check_kinds("", Scenario, yaml_load(filename=str(path)))
        scenario = yaml_load_typed(schema=Scenario, filename=str(path), defaults=Scenario())
        scenario.folder = str(path.parent)
        validate(scenario)
    except InputError as error:
        raise InputError(f"scenario {path.name}: {error}") from None
    except (YAMLError, RuntimeError, ValueError, TypeError, OSError) as error:
        words = " ".join(str(error).split())
        raise InputError(f"scenario {path.name}: {words}; see models/scenarios for what can be said") from None
    return scenario


def with_items(scenario: Scenario, kind: str) -> Scenario:
    """Make all clothes soft, or rigid (the items of a relocation are rigid, always)."""
    if kind not in KINDS:
        raise InputError(f"items {kind!r} do not exist; use {' or '.join(KINDS)}")
    if scenario.task == "laundry":
        for item in scenario.items:
            item.kind = kind
    return scenario


def _numbers(what: str, values: Sequence[float], count: int) -> None:
    if len(values) != count or not all(math.isfinite(v) for v in values):
        raise InputError(f"{what} is {list(values)}; give {count} finite numbers")


def _within(what: str, value: float, low: float, high: float) -> None:
    if not low < value <= high:
        raise InputError(f"{what} is {value:g}; give more than {low:g} and at most {high:g}")


def _one_of(what: str, value: str, known: Sequence[str]) -> None:
    if value not in known:
        raise InputError(f"{what} is {value!r}; use one of {', '.join(known)}")


def _region(what: str, region: Region, things: Sequence[str]) -> None:
    if region.frame:
        _one_of(f"{what}.frame", region.frame, things)
    _numbers(f"{what}.center", region.center, 3)
    _numbers(f"{what}.half_widths", region.half_widths, 2)
    _numbers(f"{what}.yaw_deg", region.yaw_deg, 2)
    if min(region.half_widths) < 0:
        raise InputError(f"{what}.half_widths is {region.half_widths}; give numbers of 0 or more")


def validate(scenario: Scenario) -> None:
    """Check values and names; what lies where is checked once the scene stands.

    Raises:
        InputError: with the key, its value and what it may be.
    """
    _one_of("task", scenario.task, TASKS)
    _numbers("robot.position", scenario.robot.position, 3)
    _within("contact.time_step", scenario.contact.time_step, 0.0, 0.01)
    if scenario.contact.approximation is not None:
        _one_of("contact.approximation", scenario.contact.approximation, ("lagged", "similar", "sap"))
    _one_of("contact.model", scenario.contact.model, ("hydroelastic_with_fallback", "point"))
    _within("contact.stiction_tolerance", scenario.contact.stiction_tolerance, 0.0, 0.1)
    _within("control_rate_hz", scenario.control_rate_hz, 0.0, 1000.0)
    for options in (scenario.navigation, scenario.operator, scenario.monitor):
        options.validate()
    for thing in scenario.things:
        _numbers(f"things.{thing.name}.position", thing.position, 3)
        scenario.resolve(thing.model, MODELS / "world", ".sdf")
    if not scenario.items:
        raise InputError("items is empty; give at least one thing to carry")
    names, things = [item.name for item in scenario.items], [thing.name for thing in scenario.things]
    for item in scenario.items:
        if not item.name or names.count(item.name) > 1:
            raise InputError(f"items.name is {item.name!r}; give each item a name of its own")
        _one_of(f"items.{item.name}.kind", item.kind, KINDS)
        scenario.resolve(item.model, MODELS / "items", ".sdf")
        _region(f"items.{item.name}.start", item.start, things)
        if item.soft_start is not None:
            _region(f"items.{item.name}.soft_start", item.soft_start, things)
        if item.goal is not None:
            _region(f"items.{item.name}.goal", item.goal, things)
        elif scenario.drum is None:
            raise InputError(f"items.{item.name} has no goal, and there is no drum; give one of them")
    for key in scenario.learning:
        _one_of("learning", key, [f.name for f in fields(LearningOptions)])
    if scenario.drum is not None:
        _numbers("drum.center", scenario.drum.center, 3)
        _numbers("drum.inward", scenario.drum.inward, 3)
        if sorted(map(abs, scenario.drum.inward)) != [0.0, 0.0, 1.0]:
            raise InputError(
                f"drum.inward is {scenario.drum.inward}; give a unit vector along an axis of W, and turn the robot "
                "(robot.yaw_deg) where the machine stands askew"
            )
    for end in ("pick", "place"):
        pose = getattr(scenario.retarget, end)
        if pose:
            _numbers(f"retarget.{end}", pose, 7 if len(pose) > 3 else 3)
        yaw = getattr(scenario.retarget, f"{end}_yaw_deg")
        if not math.isfinite(yaw):
            raise InputError(f"retarget.{end}_yaw_deg is {yaw}; give a finite number")
    for plane in scenario.support_planes:
        _numbers("support_planes.normal", plane.normal, 3)
    if scenario.canal is None and not scenario.demonstrations:
        raise InputError("there is neither canal nor demonstrations; give one of them")
    for name in scenario.demonstrations:
        scenario.resolve(name, MODELS / "demonstrations")
    if scenario.canal is not None:
        scenario.resolve(scenario.canal, MODELS / "demonstrations")
