"""Lists the leaf fields of messages and requests with types and defaults, and fills messages in from such values."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from tutor.ros.interfaces import interface_class
from tutor.ros.yaml_format import is_array
from tutor.ros_model import Field
from tutor.ros_model.values import format_value

_NESTED_TYPE = re.compile(r"(\w+)/(\w+)")
_BYTE_TYPES = ("octet", "sequence<octet", "octet[")


def request_fields(type_name: str) -> tuple[Field, ...]:
    """Return the leaf fields of a service type's request, in order. Raises UnknownType."""
    return tuple(_leaf_fields(interface_class(type_name).Request(), ""))


def message_fields(type_name: str) -> tuple[Field, ...]:
    """Return the leaf fields of a message type, in order. Raises UnknownType."""
    return tuple(_leaf_fields(interface_class(type_name)(), ""))


def fill_request(type_name: str, values: Mapping[str, Any]) -> Any:
    """Return a request with the given values; `values` maps field paths to values.

    Raises UnknownType, or ValueError with a one-line message if a value does not fit.
    """
    return _fill(interface_class(type_name).Request(), values)


def fill_message(type_name: str, values: Mapping[str, Any]) -> Any:
    """Return a message with the given values, like `fill_request`."""
    return _fill(interface_class(type_name)(), values)


def _fill(message: Any, values: Mapping[str, Any]) -> Any:
    types = {field.path: field.type for field in _leaf_fields(message, "")}
    for path, value in values.items():
        *parents, name = path.split(".")
        target = message
        for parent in parents:
            target = getattr(target, parent)
        try:
            setattr(target, name, _from_json(types.get(path, ""), value))
        except (AssertionError, AttributeError, TypeError, OverflowError, ValueError) as error:
            raise ValueError(f"{path}: {error}") from error
    return message


def _leaf_fields(message: Any, path: str) -> Iterator[Field]:
    for name, type_name in message.get_fields_and_field_types().items():
        here = f"{path}.{name}" if path else name
        value = getattr(message, name)
        if _NESTED_TYPE.fullmatch(type_name) and hasattr(value, "get_fields_and_field_types"):
            yield from _leaf_fields(value, here)
        else:
            yield Field(here, type_name, format_value(_plain(value)))


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if is_array(value):
        return [_plain(item) for item in value]
    return value.item() if hasattr(value, "item") else value


def _from_json(type_name: str, value: Any) -> Any:
    """Convert a JSON value to what rclpy accepts: an octet is a bytes object of length one."""
    if type_name.startswith(_BYTE_TYPES):
        return [bytes([item]) for item in value] if isinstance(value, list) else bytes([value])
    return value
