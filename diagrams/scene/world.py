"""What stands where: the robot, the fixtures around it, what it carries, and how contact is computed."""

from dataclasses import field, replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from canal.errors import InputError
from canal.options import Angle, Coordinate, Position, options, short
from diagrams.scene.model_files import check_model
from models import MODELS

Kind = Literal["soft", "rigid"]
"""How an item is simulated: as a deformable solid (soft), or as a rigid body."""


def _ordered(least_and_largest: list[float]) -> list[float]:
    if least_and_largest[0] > least_and_largest[1]:
        raise InputError("give the least first, then the largest")
    return least_and_largest


def _axis(vector: list[float]) -> list[float]:
    if sorted(map(abs, vector)) != [0.0, 0.0, 1.0]:
        raise InputError(
            "give a unit vector along an axis of W, and turn the robot (robot.yaw_deg) where the machine stands askew"
        )
    return vector


@options()
class Robot:
    """Where the base B stands in W."""

    position: Position = field(default_factory=lambda: [0.0, 0.0, 0.0])
    """p_WB [m]."""
    yaw_deg: Angle = 0.0
    """Turn about z of W."""


@options()
class Fixture:
    """A part of the surroundings, welded to the world."""

    name: str = ""
    """Names the contact pair `lio-NAME`; several fixtures may share a name, and count as one."""
    model: str = ""
    """An SDFormat file of models/world, without its ending, or a path beside the scenario."""
    position: Position = field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Of the model's origin in W [m]."""
    yaw_deg: Angle = 0.0
    """Turn about z of W."""


HalfWidth = Annotated[float, Field(ge=0, le=10)]
"""[m]"""


@options()
class Room:
    """What open fingers take about an item: the middle of no other item lies in this rectangle around it."""

    yaw_deg: Angle = 0.0
    """Direction in which the fingers open, about z of W."""
    along: HalfWidth = 0.145
    """Half its extent in that direction [m]: open fingers reach 0.094, another item 0.042, and a hand errs by 8 mm."""
    across: HalfWidth = 0.065
    """Half its extent across it [m]: fingers are 0.03 wide. More, the more the gripper leans."""
    way: list[Annotated[list[Coordinate], Field(min_length=4, max_length=4)]] = field(default_factory=list)
    """How the hand comes down, as long as it is lower than items are tall: (dx, dy, a, b) for some heights. On its way
    to (x, y), seen from the region's middle, it is above (dx + a x - b y, dy + b x + a y) [m]. Empty: straight down."""


@options()
class Region:
    """Where an item may lie, on a horizontal surface: a rectangle, or what lies within reach of a point."""

    frame: str = ""
    """The fixture in whose frame the rectangle is given, so that it goes where the fixture goes; empty: in W."""
    center: Position = field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Its middle, z on the surface [m]."""
    half_widths: Annotated[list[HalfWidth], Field(min_length=2, max_length=2)] = field(
        default_factory=lambda: [0.0, 0.0]
    )
    """Half its extent along x and y of the frame [m]."""
    reach: list[HalfWidth] = field(default_factory=list)
    """Instead of half widths: how far it reaches from the middle [m], at equal angles from x of the frame on; between
    them linear. One number is a disk."""
    yaw_deg: Annotated[list[Angle], Field(min_length=2, max_length=2), AfterValidator(_ordered)] = field(
        default_factory=lambda: [0.0, 0.0]
    )
    """Least and largest turn about z."""
    room: Room | None = None
    """What the fingers need around the item; None: `item_spacing` alone."""


@options()
class Item:
    """What is carried."""

    name: str = ""
    model: str = ""
    """An SDFormat file of models/items, without its ending; for deformable ones the kind of cloth, of the same name."""
    kind: Kind = "rigid"
    start: Region = field(default_factory=Region)
    deformable_start: Region | None = None
    """The same for the deformable one, which is longer; None: `start`."""
    goal: Region | None = None
    """Where its mark lies (relocation); without one it belongs into the drum."""
    upright: bool = False
    """Whether it must stand upright on its mark."""


@options()
class Drum:
    """Where the laundry belongs."""

    center: Position = field(default_factory=lambda: [0.0, 0.85, 0.55])
    """Centre of the door's plane in W [m]."""
    inward: Annotated[Position, AfterValidator(_axis)] = field(default_factory=lambda: [0.0, 1.0, 0.0])
    """The drum's axis, into the machine: along an axis of W, as the items' bounds are. Turn the robot instead."""
    depth: Annotated[float, Field(gt=0, le=10)] = 0.34
    """From the door's plane to the back wall, [m]."""
    radius: Annotated[float, Field(gt=0, le=10)] = 0.25
    """[m]"""


@options()
class Contact:
    """How contact is computed."""

    time_step: Annotated[float, Field(ge=1e-4, le=0.01)] = 1 / 240
    """Of the plant [s]: four steps in a tick of 60 Hz, twelve in a sample of the stick. With 5 ms what topples sinks
    into the drum by up to 5.1 mm instead of 4.6 with 4 ms, a rigid item in 60 slips by 3 mm in a carry instead of at
    most 2, and a run takes a sixth less time. With 10 ms they slip by 5 mm."""
    approximation: Literal["lagged", "similar", "sap"] | None = None
    """None: `lagged` where there is cloth, else `sap`, with which rigid items creep half as far in the hand."""
    model: Literal["hydroelastic_with_fallback", "point"] = "hydroelastic_with_fallback"
    stiction_tolerance: Annotated[float, Field(ge=1e-6, le=0.1)] = 2e-4
    """Speed [m/s] below which friction holds; what is held creeps at up to this. In a carry of 20 s cloth slips by 1 to
    2 mm; half of it takes a tenth more time; with Drake's default of 1e-3 a held item creeps 2.5 times as far. `sap`
    does not ask for it."""

    def for_items(self, deformable: bool) -> "Contact":
        """With what fits cloth, or rigid items, where nothing is said."""
        return replace(self, approximation=self.approximation or ("lagged" if deformable else "sap"))


@options()
class World:
    """A robot among fixtures, with items to carry."""

    robot: Robot = field(default_factory=Robot)
    fixtures: list[Fixture] = field(default_factory=list)
    items: list[Item] = field(default_factory=list)
    item_spacing: Annotated[float, Field(ge=0, le=10)] = 0.13
    """Least distance between the middles of two items, and of two marks, at the start [m]: the open fingers fit."""
    drum: Drum | None = None
    contact: Contact = field(default_factory=Contact)
    control_rate_hz: Annotated[float, Field(ge=1, le=1000)] = 60.0
    """Of navigator, IK and monitor (paper: 20 Hz): three ticks in a sample of the stick. At 40 Hz the tool keeps within
    7.3 mm instead of 4.6 on the way of the relocation."""
    folder: str = ""
    """Where relative paths start; set on loading."""

    def resolve(self, name: str, folder: Path, suffix: str = "") -> Path:
        """The file that a name means: beside the scenario if it is there, else in the given folder of models/.

        Args:
            name: as the scenario has it.
            folder: of models/ that is searched.
            suffix: that a name may leave out.

        Raises:
            InputError: there is no such file; names those that there are.
        """
        beside = Path(self.folder) / name
        shipped = folder / f"{name}{suffix}"
        try:
            for path in (beside, shipped):
                if path.is_file():
                    return path
        except OSError as error:
            raise InputError(f"{short(name)} cannot be looked up ({error.strerror})") from None
        there = ", ".join(sorted(p.stem if suffix else p.name for p in folder.glob(f"*{suffix or '.npz'}")))
        raise InputError(f"{short(name)} does not exist; give a file or one of {there}")


def check_world(world: World) -> None:
    """Check that what is named exists; what lies where is checked once the scene stands.

    Raises:
        InputError: with the key, its value and what it may be.
    """
    frames, names = [fixture.name for fixture in world.fixtures], [item.name for item in world.items]
    for k, fixture in enumerate(world.fixtures):
        _check_model(world, f"fixtures[{k}].model", fixture.model, carried=False)
    if not world.items:
        raise InputError("items is empty; give at least one item to carry")
    for item in world.items:
        if not item.name or names.count(item.name) > 1:
            raise InputError(f"items.name is {item.name!r}; give each item a name of its own")
        _check_model(world, f"items.{item.name}.model", item.model, carried=True)
        for key in ("start", "deformable_start", "goal"):
            region = getattr(item, key)
            if region is not None and region.frame and region.frame not in frames:
                known = ", ".join(frames)
                raise InputError(f"items.{item.name}.{key}.frame is {short(region.frame)}; use one of {known}")
        if item.goal is None and world.drum is None:
            raise InputError(f"items.{item.name} has no goal, and there is no drum; give one of them")


def _check_model(world: World, key: str, name: str, *, carried: bool) -> None:
    try:
        path = world.resolve(name, MODELS / ("items" if carried else "world"), ".sdf")
        if not path.resolve().is_relative_to(MODELS.resolve()):  # tests have looked at those that ship
            check_model(path, (Path(world.folder), MODELS), carried=carried)
    except InputError as error:
        raise InputError(f"{key}: {error}") from None
