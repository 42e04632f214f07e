"""Random options within their documented ranges: those that stand at each field."""

from __future__ import annotations

import contextlib
import dataclasses
import math
import types
import typing
from typing import Annotated, Any, Literal

import annotated_types
import numpy as np

from canal.errors import InputError
from canal.navigation.joystick import JOYSTICK_PERIOD


def random_options(current: Any, rng: np.random.Generator, *, share: float = 0.3, wild: float = 0.1) -> Any:
    """A copy of an options dataclass in which about `share` of the fields have other values, all within their bounds.

    Args:
        current: options whose values are the middle of what is tried.
        rng: what decides.
        share: of the fields that change.
        wild: share of the numbers that are taken from the ends of their range, or far out where it has no end.
    """
    hints = typing.get_type_hints(type(current), include_extras=True)
    made = current
    for f in dataclasses.fields(current):
        if f.init and rng.random() < share:
            value = random_value(hints[f.name], getattr(current, f.name), rng, share=share, wild=wild)
            for fit in (value, *_fitted(value)):
                with contextlib.suppress(InputError):
                    made = dataclasses.replace(made, **{f.name: fit})
                    break
    return made


def _fitted(value: Any) -> list[Any]:
    """What a validator may want instead: an odd number, a multiple of the stick's 50 ms."""
    if isinstance(value, int):
        return [value | 1]
    return [round(round(value / JOYSTICK_PERIOD) * JOYSTICK_PERIOD, 9)] if isinstance(value, float) else []


def random_value(hint: Any, value: Any, rng: np.random.Generator, *, share: float = 0.3, wild: float = 0.1) -> Any:
    """Another value of one field, given its annotation and its value; the same where nothing is known of it."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return random_options(value, rng, share=share, wild=wild)
    hint, bounds = _unpacked(hint)
    if typing.get_origin(hint) in (types.UnionType, typing.Union):
        members = [m for m in typing.get_args(hint) if m is not type(None)]
        if len(members) < len(typing.get_args(hint)) and rng.random() < 0.3:
            return None
        return random_value(
            Annotated[members[0], *bounds] if bounds else members[0], value, rng, share=share, wild=wild
        )
    if typing.get_origin(hint) is Literal:
        return typing.get_args(hint)[rng.integers(len(typing.get_args(hint)))]
    if hint is bool:
        return bool(rng.random() < 0.5)
    if hint in (int, float):
        number = _number(bounds, float(value if isinstance(value, (int, float)) else 1.0), rng, wild)
        return round(number) if hint is int else number
    return value


def _unpacked(hint: Any) -> tuple[Any, list[Any]]:
    """A type and what is annotated to it."""
    if typing.get_origin(hint) is not Annotated:
        return hint, []
    inner, *metadata = typing.get_args(hint)
    inner, more = _unpacked(inner)
    return inner, [*more, *(m for data in metadata for m in (getattr(data, "metadata", None) or [data]))]


def _number(bounds: list[Any], value: float, rng: np.random.Generator, wild: float) -> float:
    """A number within bounds, about the value that is there."""
    low, high = -math.inf, math.inf
    for bound in bounds:
        if isinstance(bound, (annotated_types.Ge, annotated_types.Interval)) and getattr(bound, "ge", None) is not None:
            low = max(low, float(bound.ge))  # type: ignore[arg-type]
        if isinstance(bound, annotated_types.Gt):
            low = max(low, float(bound.gt) + 1e-9)  # type: ignore[arg-type]
        if isinstance(bound, annotated_types.Le):
            high = min(high, float(bound.le))  # type: ignore[arg-type]
        if isinstance(bound, annotated_types.Lt):
            high = min(high, float(bound.lt) - 1e-9)  # type: ignore[arg-type]
    if rng.random() < wild:
        ends = [end for end in (low, high) if math.isfinite(end)]
        far = [] if math.isfinite(high) else [1e3 * abs(value), 1e9]
        number = float(rng.choice([*ends, *far] or [value]))
    elif math.isfinite(low) and math.isfinite(high) and high - low < 1e4 * max(abs(value), 1e-3):
        number = float(rng.uniform(low, high))
    else:
        number = (value or 0.05) * float(np.exp(rng.normal(scale=0.7)))
    return min(max(number, low), high)
