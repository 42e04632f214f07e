"""Options of the learn command: its own, and those of reading and learning, written once where they belong."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import tyro
from pydantic import Field

from canal.demonstration import AS_OURS, RecordingFormat
from canal.learning_options import MEASURED, LearningOptions
from canal.options import COMMAND_LINE, options
from canal.support_planes import SupportPlane
from geosacs_drake.process.command_line import parse_options

PROG = "geosacs_drake.learn"
"""Name of the command."""
_OLD_NAMES = {"--support-plane": "--support-planes"}  # singular, since it is given once for each plane


@options(COMMAND_LINE, frozen=True)
class LearnOptions:
    """Learn a canal from two or more demonstrations, in any order, and say what it is like."""

    demonstrations: tyro.conf.Positional[tuple[Path, ...]] = ()
    """Demonstrations (.npz or .csv), all from pick to place."""
    output: Annotated[Path | None, tyro.conf.arg(aliases=["-o"])] = None
    """Where to write the canal (.npz)."""
    plot: Path | None = None
    """Where to draw it (.png, .pdf, .svg); Bishop and correction frames go to NAME-frames beside it."""
    reach: bool = False
    """Say what of it the Lio reaches, and draw that to NAME-reach beside --plot or --output."""
    html: Path | None = None
    """Where to write it as a page to turn around in a browser."""
    view: bool = False
    """Show that page on localhost until Ctrl-C."""
    port: Annotated[int, Field(ge=0, le=65535)] = 0
    """TCP port for --view; 0 picks a free one."""
    recorded: Annotated[RecordingFormat, tyro.conf.arg(name="")] = AS_OURS
    """How the recordings are to be read."""
    learning: Annotated[LearningOptions, tyro.conf.arg(name="")] = MEASURED
    """How the canal is learned."""


_PRIMITIVES = tyro.constructors.ConstructorRegistry()


@_PRIMITIVES.primitive_rule
def _support_plane(info: tyro.constructors.PrimitiveTypeInfo) -> tyro.constructors.PrimitiveConstructorSpec | None:
    """A support plane as four numbers."""
    if info.type is not SupportPlane:
        return None

    def plane(words: list[str]) -> SupportPlane:
        x, y, z, offset = map(float, words)
        return SupportPlane((x, y, z), offset)

    return tyro.constructors.PrimitiveConstructorSpec(
        nargs=4,
        metavar="NX NY NZ OFFSET",
        instance_from_str=plane,
        is_instance=lambda value: isinstance(value, SupportPlane),
        str_from_instance=lambda value: [*map(str, value.normal), str(value.offset)],
    )


def parse(arguments: Sequence[str] | None = None, prog: str = PROG) -> LearnOptions:
    """The options of a command line; what it does not say is as the preset has it.

    Args:
        arguments: the command line; None: what the process was given.
        prog: the command's name, for messages.

    Raises:
        InputError: an option that is unknown or has a value that it cannot take.
    """
    words = [_OLD_NAMES.get(word, word) for word in (sys.argv[1:] if arguments is None else arguments)]
    schema: type[LearnOptions] = Annotated[LearnOptions, tyro.conf.UseAppendAction]  # type: ignore[assignment]
    with _PRIMITIVES:
        read = parse_options(schema, prog, words)
        if read.learning.preset == MEASURED.preset:
            return read
        preset = LearnOptions(learning=LearningOptions(preset=read.learning.preset))
        return parse_options(schema, prog, words, default=preset)
