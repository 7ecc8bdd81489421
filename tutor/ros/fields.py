"""The leaf fields of requests and messages, with types and defaults; and messages filled in from their values."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from tutor.ros.messages import interface_class
from tutor.ros.yaml_format import is_array
from tutor.ros_model import Field
from tutor.ros_model.values import format_value

_NESTED = re.compile(r"(\w+)/(\w+)")
_BYTES = ("octet", "sequence<octet", "octet[")


def request_fields(type_name: str) -> tuple[Field, ...]:
    """The leaf fields of a service type's request, in order. Raises UnknownType."""
    return tuple(_leaves(interface_class(type_name).Request(), ""))


def message_fields(type_name: str) -> tuple[Field, ...]:
    """The leaf fields of a message type, in order. Raises UnknownType."""
    return tuple(_leaves(interface_class(type_name)(), ""))


def fill_request(type_name: str, values: Mapping[str, Any]) -> Any:
    """A request with these values, by field path.

    Raises UnknownType, and ValueError with one line where a value does not fit.
    """
    return _fill(interface_class(type_name).Request(), values)


def fill_message(type_name: str, values: Mapping[str, Any]) -> Any:
    """A message with these values, by field path. Raises as `fill_request` does."""
    return _fill(interface_class(type_name)(), values)


def _fill(request: Any, values: Mapping[str, Any]) -> Any:
    types = {field.path: field.type for field in _leaves(request, "")}
    for path, value in values.items():
        *way, last = path.split(".")
        holder = request
        for step in way:
            holder = getattr(holder, step)
        try:
            setattr(holder, last, _as_field(types.get(path, ""), value))
        except (AssertionError, AttributeError, TypeError, OverflowError, ValueError) as error:
            raise ValueError(f"{path}: {error}") from error
    return request


def _leaves(message: Any, path: str) -> Iterator[Field]:
    for name, type_name in message.get_fields_and_field_types().items():
        here = f"{path}.{name}" if path else name
        value = getattr(message, name)
        if _NESTED.fullmatch(type_name) and hasattr(value, "get_fields_and_field_types"):
            yield from _leaves(value, here)
        else:
            yield Field(here, type_name, format_value(_plain(value)))


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if is_array(value):
        return [_plain(item) for item in value]
    return value.item() if hasattr(value, "item") else value


def _as_field(type_name: str, value: Any) -> Any:
    """Convert a value from JSON to what rclpy takes: an octet is a bytes of length one."""
    if type_name.startswith(_BYTES):
        return [bytes([item]) for item in value] if isinstance(value, list) else bytes([value])
    return value
