"""How a canal is learned: every choice by name, as measured to work or as the paper has it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

import pydantic
from pydantic import AfterValidator, Field, model_validator
from pydantic_core import ArgsKwargs

from canal.errors import InputError
from canal.options import options, read_options
from canal.support_planes import SupportPlane

BAND = 0.15  # share of the length that the warping may run ahead or behind (Sakoe-Chiba)
WARP_SMOOTHING = 0.03  # share of the length, σ of the smoothing of the warps
ALPHA = 9.0  # α of the paper's Table I
BETA = 0.3  # β of the paper's Table I

PAPER: dict[str, Any] = {
    "interpolate": True,  # V-A: a spline through the points that the step filter leaves
    "soft_trimming": False,  # V-A knows no trimming: pauses are left to the alignment
    "band": 1.0,  # of the time warping, which the paper does not bound
    "warp_smoothing": 0.0,  # nor smooth
    "even_parameter": False,  # the common parameter is the place on the warping path
    "relax_disks": False,  # IV-B: disks are orthogonal to e_T
    "cap_x_turn": False,  # IV-B: x_s is what the slerp says
    "y_window": 10,  # IV-B
}
"""Where the paper says or implies something else than our defaults; docs/deviations.md has reasons and measurements."""
PRESETS: dict[str, dict[str, Any]] = {"measured": {}, "paper": PAPER}
"""By name: the options that differ from the defaults."""


def _odd(n_disks: int) -> int:
    if n_disks % 2 == 0:
        raise InputError("give an odd number, so that home is a disk")
    return n_disks


def _direction(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if math.hypot(*vector) < 1e-9:
        raise InputError("give a direction, not zero")
    return vector


@options("learning", frozen=True)
class LearningOptions:
    """How a canal is learned. The defaults are what was measured to work on recorded and hard synthetic data.

    Attributes:
        preset: what options are that are not given: `measured`, our defaults, or `paper`, the paper's rules and
            constants.
        step: h, distance of knots as a share of the whole (paper: the step of the filter).
        interpolate: splines through every h-th sample, as in the paper, instead of least squares.
        soft_trimming: leave out what does not move before aligning; the paper does not.
        band: how far the alignment may run ahead or behind, as a share of the whole.
        warp_smoothing: σ of the smoothing of the alignment, as a share of the whole.
        even_parameter: a common parameter that is uniform in what all demonstrations move, instead of one along
            the warping path.
        margin: added to every radius, [m].
        contain_raw: widen radii until every recorded sample lies in a ball, not only every aligned point.
        ellipse: elliptic cross-sections where three or more demonstrations allow it.
        n_disks: odd number of disks; None for one every 5 mm, 200 to 1000 of them.
        relax_disks: tilt disks until neighbours do not cross inside the canal; in the paper they are orthogonal to e_T.
        x_global: x_G, the direction that corrections along x follow, in B.
        cap_x_turn: bound the turn of x from disk to disk, so that a point at the rim moves no further than the disk.
        y_window: number of previous disks whose mean y decides on the sign of the next (paper: 10).
        support_planes: tables, walls and doors: a normal, and the offset along it, [m], in B. The robot is where n·p
            is larger.
        alpha: α of the orientation weight exp(-α (σ - β)).
        beta: β of it, the spread σ at which the weight is 1.
    """

    preset: Literal["measured", "paper"] = "measured"
    step: Annotated[float, Field(ge=0.005, le=0.5)] = 0.1
    interpolate: bool = False
    soft_trimming: bool = True
    band: Annotated[float, Field(ge=0.01, le=1)] = BAND
    warp_smoothing: Annotated[float, Field(ge=0, le=0.5)] = WARP_SMOOTHING
    even_parameter: bool = True
    margin: Annotated[float, Field(ge=0, le=1)] = 0.0
    contain_raw: bool = False
    ellipse: bool = False
    n_disks: Annotated[int, Field(ge=3, le=10_001), AfterValidator(_odd)] | None = None
    relax_disks: bool = True
    x_global: Annotated[tuple[float, float, float], AfterValidator(_direction)] = (1.0, 0.0, 0.0)
    cap_x_turn: bool = True
    y_window: Annotated[int, Field(ge=1, le=1000)] = 1
    support_planes: tuple[SupportPlane, ...] = ()
    alpha: Annotated[float, Field(ge=0, le=100)] = ALPHA
    beta: Annotated[float, Field(ge=-10, le=10)] = BETA

    @model_validator(mode="before")
    @classmethod
    def _fill_from_preset(cls, given: Any) -> Any:
        """What is not given is the preset's."""
        named = given.kwargs if isinstance(given, ArgsKwargs) else given
        if not isinstance(named, Mapping) or not isinstance(named.get("preset"), str):
            return given
        filled = PRESETS.get(named["preset"], {}) | dict(named)
        return ArgsKwargs(given.args, filled) if isinstance(given, ArgsKwargs) else filled


MEASURED = LearningOptions()
"""The defaults."""


def to_json(learning: LearningOptions) -> str:
    """All options as one line, for a canal file."""
    return pydantic.TypeAdapter(LearningOptions).dump_json(learning).decode()


def from_json(text: str) -> LearningOptions:
    """Options from such a line.

    Raises:
        InputError: it is none, or holds a value that cannot be used.
    """
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        raise InputError("options are no JSON; make the file again with learn -o") from None
    return read_options(LearningOptions, value)
