"""Says where a YAML document does not have the shape of a dataclass, by key, before it is read."""

import types
import typing
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from canal.errors import InputError


def check_kinds(where: str, schema: Any, value: Any) -> None:
    """Compare a value, as YAML gives it, with a type: dataclass, list, dict, optional, number, text, truth.

    Args:
        where: the key that holds it, with dots; empty for the document.
        schema: a type.
        value: what was read.

    Raises:
        InputError: a key is unknown, or a value is of another kind; names the key, the value and what belongs there.
    """
    origin, arguments = typing.get_origin(schema), typing.get_args(schema)
    if origin in (typing.Union, types.UnionType):
        if value is None and type(None) in arguments:
            return
        schema = next(a for a in arguments if a is not type(None))
        check_kinds(where, schema, value)
    elif is_dataclass(schema):
        known = {f.name: f.type for f in fields(schema)}
        _expect(where, value, Mapping, f"keys among {', '.join(known)}")
        for key, item in value.items():
            if key not in known:
                raise InputError(f"{_join(where, key)} is not known; use {', '.join(known)}")
            check_kinds(_join(where, key), known[key], item)
    elif origin is list:
        _expect(where, value, list, "a list")
        for k, item in enumerate(value):
            check_kinds(f"{where}[{k}]", arguments[0], item)
    elif origin is dict:
        _expect(where, value, Mapping, "keys with values")
        for key, item in value.items():
            check_kinds(_join(where, key), arguments[1], item)
    elif schema is bool:
        _expect(where, value, bool, "true or false")
    elif schema in (int, float):
        # YAML 1.1 takes 5e-4 for text; its reader, like ours, does not.
        try:
            float(value)
        except (TypeError, ValueError):
            raise InputError(f"{where} is {value!r}; give a number") from None
    elif schema is str:
        _expect(where, value, str, "text")


def _join(where: str, key: object) -> str:
    return f"{where}.{key}" if where else str(key)


def _expect(where: str, value: object, kind: type, wanted: str) -> None:
    if not isinstance(value, kind):
        raise InputError(f"{where or 'the document'} is {value!r}; give {wanted}")
