"""Messages and services by type name, and messages as plain mappings."""

from __future__ import annotations

import array
import importlib
import importlib.util
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from tutor.errors import UnknownType

MOST_CHARACTERS, MOST_ELEMENTS = 10_000, 100_000
"""How much is kept of a text, and of all arrays of a message."""

_EACH = 16
_RECEIVED = 8
"""Bytes that are received and not kept count as a byte for this many."""


@cache
def interface_class(name: str) -> Any:
    """The class of a message or service type, from a name such as `std_msgs/msg/Float64`.

    Raises UnknownType where the package or the type is not installed.
    """
    try:
        package, kind, type_name = name.split("/")
        if not _has_interfaces(package):  # the name may be a learner's: do not import just any module
            raise UnknownType(name)
        found: Any = getattr(importlib.import_module(f"{package}.{kind}"), type_name)
    except (ValueError, ImportError, AttributeError) as error:
        raise UnknownType(name) from error
    return found


def _has_interfaces(package: str) -> bool:
    """Whether a top-level package has type support for messages and services."""
    found = importlib.util.find_spec(package) if package.isidentifier() else None
    places = (found.submodule_search_locations or ()) if found else ()
    return any(any(Path(place).glob(f"{package}_s__rosidl_typesupport_c*.so")) for place in places)


def to_plain(message: Any) -> dict[str, Any]:
    """A message as a dict of its fields; nested messages become dicts, arrays become lists.

    Texts are cut after `MOST_CHARACTERS`, and arrays where the message has more than `MOST_ELEMENTS` in all.
    """
    return to_plain_and_size(message)[0]


def to_plain_and_size(message: Any) -> tuple[dict[str, Any], int]:
    """A message as `to_plain` gives it, and its cost in memory, in bytes; what is cut off counts in part."""
    room = _Room()
    plain = room.message(message)
    return plain, room.bytes


def truncate(text: str, most: int = MOST_CHARACTERS) -> str:
    """The text, cut at `most` characters with an ellipsis."""
    return text if len(text) <= most else f"{text[: most - 3]}..."


def kept_bytes(text: str, kept: str) -> int:
    """The cost in memory, in bytes, of the part of a text that is kept; what is cut off counts in part."""
    return _EACH + len(kept) * (1 if kept.isascii() else 4) + len(text) // _RECEIVED


def set_fields(message: Any, values: Mapping[str, Any]) -> Any:
    """Set the fields of `message` and return it. Raises AttributeError for an unknown field."""
    for name, value in values.items():
        setattr(message, name, value)
    return message


def placeholder_message(message_type: Any, text: str) -> Any:
    """A message in place of one that cannot be looked into: its own texts say so, all else is as by default."""
    message = message_type()
    for name, type_name in message.get_fields_and_field_types().items():
        if type_name == "string":
            setattr(message, name, text)
    return message


class _Room:
    """What one message may take."""

    def __init__(self) -> None:
        self.bytes = 0
        self._elements = MOST_ELEMENTS

    def message(self, message: Any) -> dict[str, Any]:
        return {name: self._plain(getattr(message, name)) for name in message.get_fields_and_field_types()}

    def _plain(self, value: Any) -> Any:
        if hasattr(value, "get_fields_and_field_types"):
            return self.message(value)
        if isinstance(value, str):
            kept = truncate(value)
            self.bytes += kept_bytes(value, kept)
            return kept
        if isinstance(value, (bytes, list, tuple, array.array)) or hasattr(value, "tolist"):
            kept = value[: self._elements]
            self._elements -= len(kept)
            self.bytes += _EACH * len(kept) + len(value) // _RECEIVED
            return [self._plain(item) for item in kept]
        self.bytes += _EACH
        return value
