"""The fields of messages: lists the leaf ones with types and defaults, and sets them from typed or YAML values."""

from __future__ import annotations

import array
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from tutor.ros.interfaces import interface_class
from tutor.ros.messages import is_message, plain_value
from tutor.ros_model import Field
from tutor.ros_model.values import format_value

_NESTED_TYPE = re.compile(r"(\w+)/(\w+)")
_BYTE_TYPES = ("octet", "sequence<octet", "octet[")

SetStamp = Callable[[Any], None]
"""A function that is given the current time, as builtin_interfaces/msg/Time, and stores it in the message."""


def leaf_fields(message: Any, path: str = "") -> Iterator[Field]:
    """Yield the leaf fields of a message or request, in order."""
    for name, type_name in message.get_fields_and_field_types().items():
        here = f"{path}.{name}" if path else name
        value = getattr(message, name)
        if _NESTED_TYPE.fullmatch(type_name) and is_message(value):
            yield from leaf_fields(value, here)
        else:
            yield Field(here, type_name, format_value(plain_value(value)))


def assign(message: Any, values: Mapping[str, Any]) -> Any:
    """Set the fields in `values` as they are, those of nested messages too, and return the message.

    Raises AttributeError for an unknown field.
    """
    for name, value in values.items():
        if isinstance(value, Mapping):
            assign(getattr(message, name), value)
        else:
            setattr(message, name, value)
    return message


def fill(message: Any, values: Mapping[str, Any]) -> Any:
    """Set the fields at the paths in `values`, whose values are of the fields' types, and return the message.

    Raises ValueError with a one-line message if a value does not fit.
    """
    types = {field.path: field.type for field in leaf_fields(message)}
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


def set_fields(message: Any, values: Any, stamps: list[SetStamp] | None = None) -> None:
    """Set the fields that the mapping `values` names, as rosidl_runtime_py does; the others keep their defaults.

    A value is converted by the field's type: `int(1.5)` is 1. Where there are `stamps`, a header may be `auto` and a
    time `now`; functions that fill these in are added. Raises whatever the conversion raises (AttributeError,
    TypeError, ValueError and the like), with the message that ros2cli shows.
    """
    if not isinstance(values, Mapping):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    slots = (
        dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True)) if is_message(message) else {}
    )
    for name, value in values.items():
        field = getattr(message, name)
        kind = f"{type(field).__module__}.{type(field).__name__}"
        if stamps is not None and value == "auto" and kind == "std_msgs.msg._header.Header":
            stamps.append(_stamp_setter(field, "stamp"))
        elif stamps is not None and value == "now" and kind == "builtin_interfaces.msg._time.Time":
            stamps.append(_stamp_setter(message, name))
        else:
            setattr(message, name, _convert(field, value, slots.get(name), stamps))


def _from_json(type_name: str, value: Any) -> Any:
    """Convert a JSON value to what rclpy accepts: an octet is a bytes object of length one."""
    if type_name.startswith(_BYTE_TYPES):
        return [bytes([item]) for item in value] if isinstance(value, list) else bytes([value])
    return value


def _convert(field: Any, value: Any, slot: Any, stamps: list[SetStamp] | None) -> Any:
    if isinstance(field, array.array):
        return array.array(field.typecode, value)
    if type(field).__module__ == "numpy":
        return _to_numpy(value, field.dtype)
    if is_message(field):
        return _new(type(field), value, stamps)
    try:
        converted = value if type(value) is type(field) else type(field)(value)
    except TypeError:  # rosidl_runtime_py treats any value it cannot convert as a nested message, and its error says so
        converted = _new(type(field), value, stamps)
    element_name = getattr(getattr(slot, "value_type", None), "namespaced_name", None)
    if isinstance(converted, list) and element_name is not None:
        kind = interface_class("/".join(element_name()))
        return [_new(kind, item, stamps) for item in converted]
    return converted


def _new(kind: Any, values: Any, stamps: list[SetStamp] | None) -> Any:
    message = kind()
    set_fields(message, values, stamps)
    return message


def _to_numpy(value: Any, dtype: Any) -> Any:
    import numpy as np  # late: only messages with fixed-size arrays need it

    return np.array(value, dtype=dtype)


def _stamp_setter(holder: Any, name: str) -> SetStamp:
    return lambda now: setattr(holder, name, now)
