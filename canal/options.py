"""Options: dataclasses whose fields state what they may be, checked by pydantic, refused in one line of ours."""

from __future__ import annotations

import dataclasses
import reprlib
import textwrap
import typing
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Annotated, Any, cast, dataclass_transform

import pydantic
import pydantic.dataclasses
from pydantic import ConfigDict, Field
from pydantic_core import ArgsKwargs

from canal.errors import InputError

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Share = Annotated[float, Field(ge=0, le=1)]
"""Numbers above 0, from 0 on, and from 0 to 1."""
Coordinate = Annotated[float, Field(ge=-100, le=100)]
"""[m]: a robot's surroundings; what is further away was given in other units."""
Vector3 = Annotated[list[float], Field(min_length=3, max_length=3)]
Position = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]
"""Lists of so many finite numbers."""
Angle = Annotated[float, Field(ge=-360, le=360)]
"""[deg]"""

COMMAND_LINE = "--"
"""Where options are that a person types: a field is named as its option, `realtime_rate` as --realtime-rate."""

CONFIG = ConfigDict(extra="forbid", allow_inf_nan=False)
"""Unknown keys are refused, and every number is finite unless its field says otherwise."""

_SHORT = reprlib.Repr(maxlist=8, maxtuple=8, maxdict=4, maxstring=80, maxother=80, maxlong=40, maxlevel=3)


@dataclass_transform(field_specifiers=(dataclasses.field, Field))
def options[T: type](where: str = "", *, frozen: bool = False) -> Callable[[T], T]:
    """Make a dataclass of options: pydantic checks each field by its annotation when one is made.

    Args:
        where: the key that holds these options, for messages ("navigation" gives "navigation.delta is 0; ..."), or
            `COMMAND_LINE`.
        frozen: whether fields can be set afterwards.

    Returns:
        A decorator. The class raises `InputError` for a value that is out of bounds.
    """

    def decorate(cls: T) -> T:
        made: Any = pydantic.dataclasses.dataclass(config=CONFIG, frozen=frozen)(cls)
        check = made.__init__

        def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
            try:
                check(self, *args, **kwargs)
            except pydantic.ValidationError as error:
                raise InputError(describe(error, made, where)) from None

        __init__.__wrapped__ = check  # type: ignore[attr-defined]
        made.__init__ = __init__
        return cast(T, made)

    return decorate


def read_options[T](schema: type[T], value: object, renamed: Mapping[str, str] = MappingProxyType({})) -> T:
    """Make options from plain data, as YAML gives it.

    Args:
        schema: a class made by `options`.
        value: a mapping of its fields.
        renamed: keys of earlier versions, and what they are called now.

    Raises:
        InputError: a key is unknown, or a value cannot be used; names the key, the value and what belongs there.
    """
    try:
        return pydantic.TypeAdapter(schema).validate_python(value)
    except pydantic.ValidationError as error:
        raise InputError(describe(error, schema, "", renamed)) from None


def describe(
    error: pydantic.ValidationError, schema: type, where: str, renamed: Mapping[str, str] = MappingProxyType({})
) -> str:
    """The first fault, in one line.

    Args:
        error: of pydantic.
        schema: the dataclass that was to be made, whose fields are listed where a key is unknown.
        where: the key that holds it.
        renamed: keys of earlier versions, and what they are called now.
    """
    first = error.errors(include_url=False)[0]
    kind, context = first["type"], first.get("ctx", {})
    path = [key for key in first["loc"] if not (isinstance(key, str) and "[" in key)]  # names of union members
    names = _field_names(schema, ())
    if path and isinstance(path[0], int) and path[0] < len(names):  # an argument by its place
        path[0] = names[path[0]]
    key = _key(where, path)
    if kind in ("unexpected_keyword_argument", "extra_forbidden"):
        known = _field_names(schema, path[:-1])
        if path and renamed.get(str(path[-1])) in known:
            return f"{key} is now called {renamed[str(path[-1])]}; write that"
        return f"{key} is not known; use {', '.join(known)}"
    if kind in ("missing", "missing_argument"):
        return f"{key} is missing; give it"
    value = f"{key or 'the document'} is {short(first['input'])}"
    if kind in ("value_error", "assertion_error"):
        whole = isinstance(first["input"], (dict, ArgsKwargs))  # an error of several fields together
        return (f"{key}: " if key else "") + str(context["error"]) if whole else f"{value}; {context['error']}"
    return f"{value}; give {_wanted(kind, context, schema, path)}"


def short(value: object) -> str:
    """A value as a person can read it in one line, however large it is."""
    try:
        text = _SHORT.repr(value)
    except ValueError:  # an integer of more digits than Python prints
        text = "a number of too many digits"
    return textwrap.shorten(" ".join(text.split()), 120, placeholder=" ...")


_WANTED = {
    "greater_than": "a number above {gt:g}",
    "greater_than_equal": "a number of {ge:g} or more",
    "less_than": "a number below {lt:g}",
    "less_than_equal": "a number of at most {le:g}",
    "finite_number": "a finite number",
    "float_type": "a number",
    "float_parsing": "a number",
    "int_type": "a whole number",
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "int_parsing_size": "a smaller whole number",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "string_type": "text",
    "string_too_short": "text of at least {min_length} letters",
    "string_too_long": "text of at most {max_length} letters",
    "list_type": "a list",
    "tuple_type": "a list",
    "literal_error": "one of {expected}",
    "enum": "one of {expected}",
}


def _wanted(kind: str, context: dict[str, Any], schema: type, path: Sequence[str | int]) -> str:
    """What belongs where something of another kind was found."""
    if kind in ("dataclass_type", "dict_type"):
        return f"keys among {', '.join(_field_names(schema, path))}"
    if kind in ("too_short", "too_long"):
        count = context.get("min_length", context.get("max_length"))
        return f"{count} of them"
    if kind in _WANTED:
        return _WANTED[kind].format(**context).replace("'", "")
    return kind.replace("_", " ")


def _at(schema: Any, path: Sequence[str | int]) -> Any:
    """The type that a path of keys leads to; None where that is no dataclass."""
    for key in path:
        schema = _inner(schema)
        if isinstance(key, int):
            schema = (typing.get_args(schema) or (None,))[0]
        elif dataclasses.is_dataclass(schema):
            schema = typing.get_type_hints(schema, include_extras=False).get(key)
        else:
            return None
    return _inner(schema)


def _inner(schema: Any) -> Any:
    """A type without Annotated and without "or None"."""
    while typing.get_origin(schema) is Annotated:
        schema = typing.get_args(schema)[0]
    members = [a for a in typing.get_args(schema) if a is not type(None)]
    if len(members) == 1 and type(None) in typing.get_args(schema):
        return _inner(members[0])
    return schema


def _field_names(schema: type, path: Sequence[str | int]) -> list[str]:
    """Names of the fields of the dataclass that a path leads to."""
    found = _at(schema, path)
    return [f.name for f in dataclasses.fields(found) if f.init] if dataclasses.is_dataclass(found) else []


def _key(where: str, path: Sequence[str | int]) -> str:
    """A path of keys as a person writes it: items[0].goal.center, or --real-time-rate for an option."""
    text = "" if where == COMMAND_LINE else where
    for key in path:
        text += f"[{key}]" if isinstance(key, int) else f".{key}" if text else str(key)
    return f"--{text.replace('_', '-')}" if where == COMMAND_LINE and text else text
