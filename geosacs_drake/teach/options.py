"""Options of the teach command."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from canal.errors import InputError
from canal.options import COMMAND_LINE, options


@options(COMMAND_LINE, frozen=True)
class TeachOptions:
    """Record demonstrations in the simulation, from a page: jog the tool, save, learn the canal, and travel it."""

    scenario: str = "relocation"
    """A scenario file (.yaml), or the name of one that ships: what stands where while you teach."""
    output: Path = Path("taught")
    """Folder for the demonstrations and the canals; it is made where it is missing. Nothing in it is overwritten."""
    items: Literal["soft", "rigid"] | None = None
    """Soft clothes (finite elements) or rigid bodies. Default: as the scenario says."""
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    """Draws where items lie."""
    realtime_rate: Annotated[float, Field(ge=0, lt=1e6)] | None = None
    """Simulated over real time; 0 for as fast as possible. Default: 1 in a browser, 0 headless."""
    port: int | None = None
    """Port of the page on localhost. Default: the first free one from 7000 on."""
    host: str = "localhost"
    """Address at which the page is served. 0.0.0.0 lets every machine of the network that knows its address move the
    robot: for a tablet, in a network that you trust."""
    headless: bool = False
    """Without a browser, as fast as it goes: a script moves the tool."""
    script: Path | None = None
    """What the hand does, step by step (.yaml), for --headless."""

    def __post_init__(self) -> None:
        if self.headless and self.script is None:
            raise InputError("--headless needs a hand: give --script FILE.yaml, or leave --headless out")
        if self.script is not None and not self.headless:
            raise InputError("--script moves the tool with nobody looking: give --headless, too")
        if self.host != "localhost" and self.headless:
            raise InputError(f"--host {self.host} is the page's: leave --headless out")

    @property
    def rate(self) -> float:
        """The real-time rate to aim at; 0 for as fast as possible."""
        if self.realtime_rate is not None:
            return self.realtime_rate
        return 0.0 if self.headless else 1.0
