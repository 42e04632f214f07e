"""What a page may say: numbered, small, checked; what does not fit is refused."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

MOST_BYTES = 4096
"""Of a message; a binding of a gamepad is the longest."""

Coordinate = Annotated[float, Field(allow_inf_nan=False)]
"""A finite number."""
Pair = tuple[Coordinate, Coordinate]
"""Two finite numbers."""
Triple = tuple[Coordinate, Coordinate, Coordinate]
"""Three finite numbers."""
Name = Annotated[str, Field(min_length=1, max_length=60, pattern=r"^[\w .()+-]+$")]
"""Of a device's bindings: at most 60 letters, none that means something in a path."""


class Message(BaseModel):
    """What all have: a number that grows, and the page's clock."""

    model_config = ConfigDict(extra="forbid", strict=False)

    n: Annotated[int, Field(ge=0, lt=2**53, strict=True)]
    t: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 0.0
    """[ms]"""


class Drive(Message):
    """The stick: to the right and up in the unit disc; said again while it is held."""

    type: Literal["drive"]
    """Tells it apart."""
    stick: Pair


class Step(Message):
    """A movement of a chosen length, in a direction of the stick."""

    type: Literal["step"]
    """Tells it apart."""
    direction: Pair
    """Right and up; its length does not matter."""
    mm: Annotated[float, Field(gt=0, le=50, allow_inf_nan=False)]
    """[mm]"""


class Press(Message):
    """A button, once."""

    type: Literal["press"]
    """Tells it apart."""
    button: Literal["gripper", "reverse", "start", "stop"]


class Say(Message):
    """A word about who steers, or about the run."""

    type: Literal["take", "hand_back", "watch", "again", "leave", "hello"]
    """The word."""


class View(Message):
    """Which directions of the robot's base frame are right and up in the person's view, and which mapping is used."""

    type: Literal["view"]
    mapping: Literal["axes", "seat", "view"]
    seat: Literal["front", "left", "right", "behind"] = "front"
    follow: bool = False
    """Whether the view is the gripper's."""
    right: Triple | None = None
    """Right in the person's view, in B; None: not known."""
    up: Triple | None = None
    """Up in the person's view, in B; None: not known."""


class Seen(Message):
    """The status that was shown, by its number: tells the delay of the link."""

    type: Literal["seen"]
    """Tells it apart."""
    status: Annotated[int, Field(ge=0, lt=2**53)]
    """Number of the status."""


class Bindings(Message):
    """How the controls of a device are bound, to be kept under a name."""

    type: Literal["bindings"]
    """Tells it apart."""
    name: Name
    """Under which they are kept."""
    bindings: dict[str, Any] = Field(max_length=40)
    """A control for each name of a direction or a button."""


class Look(Message):
    """A page waits for a picture of the gripper's camera: one."""

    type: Literal["look"]
    """Tells it apart."""


class Jog(Message):
    """How the tool is moved while it is taught: velocity and the way its nose tips, in the base frame, and its spin;
    said again while it is held, or once for a step."""

    type: Literal["jog"]
    move: Triple = (0.0, 0.0, 0.0)
    nose: Triple = (0.0, 0.0, 0.0)
    spin: Coordinate = 0.0
    mm: Annotated[float, Field(gt=0, le=50, allow_inf_nan=False)] | None = None
    """[mm] of a step; None: it is held."""


class Teach(Message):
    """What is to become of what is taught."""

    type: Literal["teach"]
    """Tells it apart."""
    word: Literal["record", "pause", "undo", "back", "save", "discard", "reset", "learn", "travel"]
    """What is to be done."""


AnyMessage = Annotated[
    Drive | Step | Press | Say | View | Seen | Bindings | Look | Jog | Teach, Field(discriminator="type")
]
"""What a page may send, told apart by its type."""
_ADAPTER: TypeAdapter[AnyMessage] = TypeAdapter(AnyMessage)


def read_message(text: str | bytes, last: int) -> AnyMessage:
    """A message from a page.

    Args:
        text: as it came.
        last: number of the one before.

    Raises:
        ValueError: it is broken; says how, in a few words.
    """
    if not isinstance(text, str):
        raise ValueError("give text, not bytes")
    if len(text) > MOST_BYTES:
        raise ValueError(f"give at most {MOST_BYTES} letters")
    try:
        message = _ADAPTER.validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        raise ValueError(f"{'.'.join(map(str, first['loc']))}: {first['msg']}"[:200]) from None
    if message.n <= last:
        raise ValueError(f"n is {message.n} after {last}: count up")
    return message
