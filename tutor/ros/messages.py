"""Messages and services by type name, and messages as plain mappings."""

from __future__ import annotations

import array
import importlib
from collections.abc import Mapping
from functools import cache
from typing import Any


class UnknownType(LookupError):
    """A type name that this ROS does not have."""


@cache
def interface(name: str) -> Any:
    """The class of a message or service type, from a name such as `std_msgs/msg/Float64`.

    Raises UnknownType where the package or the type is not installed.
    """
    try:
        package, kind, type_name = name.split("/")
        found: Any = getattr(importlib.import_module(f"{package}.{kind}"), type_name)
    except (ValueError, ImportError, AttributeError) as error:
        raise UnknownType(name) from error
    return found


def to_plain(message: Any) -> dict[str, Any]:
    """A message as a dict of its fields; nested messages become dicts, arrays become lists."""
    return {name: _plain(getattr(message, name)) for name in message.get_fields_and_field_types()}


def fill(message: Any, values: Mapping[str, Any]) -> Any:
    """Set the fields of `message` and return it. Raises AttributeError for an unknown field."""
    for name, value in values.items():
        setattr(message, name, value)
    return message


def _plain(value: Any) -> Any:
    if hasattr(value, "get_fields_and_field_types"):
        return to_plain(value)
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, (list, tuple, array.array)) or hasattr(value, "tolist"):
        return [_plain(item) for item in value]
    return value
