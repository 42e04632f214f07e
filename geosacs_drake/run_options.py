"""Options of a run, the same for both tasks."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from canal.errors import InputError
from canal.options import COMMAND_LINE, options

PEOPLE = ("gamepad", "keyboard", "person")
"""Operators that need a browser."""


@options(COMMAND_LINE, frozen=True)
class RunOptions:
    """Load a washing machine, or move items from table to table, by shared autonomy on a canal."""

    operator: str = "simulated"
    """simulated, a person at the page (gamepad, keyboard or person: each means all of its controls), or a file with a
    recorded joystick (.npz or .csv). A log (--log) is replayed with its own scenario, canal and seed. Only where a
    person is asked for does the page take commands."""
    headless: bool = False
    """Without a browser, as fast as it goes, with a progress bar."""
    realtime_rate: Annotated[float, Field(ge=0, lt=1e6)] | None = None
    """Simulated over real time; 0 for as fast as possible. Default: 1 in a browser, 0 headless."""
    seed: Annotated[int, Field(ge=0, lt=2**63)] | None = None
    """Draws where items lie, and the simulated operator's errors. Default: 0, or that of the log that is replayed."""
    duration: Annotated[float, Field(gt=0, lt=1e6)] | None = None
    """Longest simulated time [s]; what is not done by then is not done. Default: 900, or that of the log."""
    items: Literal["soft", "rigid"] | None = None
    """Soft clothes (finite elements) or rigid bodies. Default: as the scenario says; soft in laundry."""
    scenario: str | None = None
    """A scenario file (.yaml), or the name of one that ships."""
    demos: tuple[Path, ...] = ()
    """Demonstrations to learn the canal from, two or more, instead of the scenario's."""
    canal: Path | None = None
    """A learned canal (.npz) instead of the scenario's; see geosacs_drake.learn."""
    summary: Path | None = None
    """Write the study's measures here, as JSON."""
    log: Path | None = None
    """Write all signals at the control rate here, as .npz."""
    record: Path | None = None
    """Write a page here (.html) that replays the run with no network."""
    video: Path | None = None
    """Write a film here (.gif, or .mp4 where ffmpeg is), seen from the room, with the gripper's view inset."""
    port: int | None = None
    """Port of the page on localhost. Default: the first free one from 7000 on."""
    console: bool = True
    """The operator's console: one page with the robot, a joystick, and what the robot does. --no-console leaves
    Meshcat's page alone."""
    mapping: Literal["axes", "seat", "view"] | None = None
    """What the stick's right and up are: the canal's correction axes, as in the paper, or right and up as seen from the
    seat, or by the camera. Default: as the scenario says; by the camera in the console."""
    seat: Literal["front", "left", "right", "behind"] | None = None
    """Where the person sits, seen from the robot. Default: as the scenario says; front."""
    host: str = "localhost"
    """Address at which the console listens. 0.0.0.0 lets every machine of the network that knows its address steer the
    robot: for a tablet, in a network that you trust."""

    def __post_init__(self) -> None:
        if self.headless and self.operator in PEOPLE:
            raise InputError(f"--operator {self.operator} needs a browser: leave --headless out")
        if self.host != "localhost" and (self.headless or not self.console):
            raise InputError(f"--host {self.host} is the console's: leave --headless and --no-console out")
        if self.demos and self.canal:
            raise InputError("--demos and --canal exclude each other: give one of them")
        if len(self.demos) == 1:
            raise InputError("--demos got one file; a canal needs at least two demonstrations")

    @property
    def rate(self) -> float:
        """The real-time rate to aim at; 0 for as fast as possible."""
        if self.realtime_rate is not None:
            return self.realtime_rate
        return 0.0 if self.headless else 1.0
