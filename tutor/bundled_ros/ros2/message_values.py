"""Fill messages from YAML values, with the same conversions as rosidl_runtime_py."""

from __future__ import annotations

import array
import importlib
from collections.abc import Callable, Mapping
from typing import Any

from tutor.bundled_ros.ros2.yaml_errors import yaml_problem
from tutor.errors import CommandError

SetStamp = Callable[[Any], None]
"""A function that is given the current time, as builtin_interfaces/msg/Time, and stores it in the message."""


def message_from_yaml(kind: Any, text: str, *, failed: str) -> Any:
    """Build a message of class `kind` from a YAML text; fields that the text does not name keep their defaults.

    Raises CommandError. For a value that does not fit its field, the message is `failed`, with `{}` for the error.
    """
    import yaml

    message = kind()
    try:
        set_fields(message, yaml.safe_load(text))
    except yaml.YAMLError as error:
        raise CommandError(f"The passed value is not YAML: {yaml_problem(error)}") from error
    except Exception as error:  # any error of a field's setter describes what is wrong with the value
        raise CommandError(failed.format(error)) from error
    return message


def set_fields(message: Any, values: Any, *, stamps: bool = False) -> list[SetStamp]:
    """Set the fields of `message` that the mapping `values` names; the others keep their defaults.

    A value is converted by the field's type: `int(1.5)` is 1. With `stamps`, a header may be `auto` and a time `now`;
    the returned functions fill these in. Raises whatever the conversion raises (AttributeError, TypeError, ValueError
    and the like), with the message that ros2cli shows.
    """
    if not isinstance(values, Mapping):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    setters: list[SetStamp] = []
    slots = (
        dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True)) if is_message(message) else {}
    )
    for name, value in values.items():
        field = getattr(message, name)
        kind = f"{type(field).__module__}.{type(field).__name__}"
        if stamps and value == "auto" and kind == "std_msgs.msg._header.Header":
            setters.append(_stamp_setter(field, "stamp"))
        elif stamps and value == "now" and kind == "builtin_interfaces.msg._time.Time":
            setters.append(_stamp_setter(message, name))
        else:
            setattr(message, name, _convert(field, value, slots.get(name), stamps, setters))
    return setters


def is_message(value: Any) -> bool:
    """Return whether a value is of a ROS message type rather than one of Python's or numpy's."""
    return hasattr(value, "get_fields_and_field_types")


def _convert(field: Any, value: Any, slot: Any, stamps: bool, setters: list[SetStamp]) -> Any:
    if isinstance(field, array.array):
        return array.array(field.typecode, value)
    if type(field).__module__ == "numpy":
        return _to_numpy(value, field.dtype)
    if is_message(field):
        nested = type(field)()
        setters += set_fields(nested, value, stamps=stamps)
        return nested
    try:
        converted = value if type(value) is type(field) else type(field)(value)
    except TypeError:  # rosidl_runtime_py treats any value it cannot convert as a nested message, and its error says so
        setters += set_fields(converted := type(field)(), value, stamps=stamps)
    element = getattr(slot, "value_type", None)
    if isinstance(converted, list) and hasattr(element, "namespaced_name"):
        return [_build_element(element, each, stamps, setters) for each in converted]
    return converted


def _build_element(kind: Any, values: Any, stamps: bool, setters: list[SetStamp]) -> Any:
    *where, name = kind.namespaced_name()
    message = getattr(importlib.import_module(".".join(where)), name)()
    setters += set_fields(message, values, stamps=stamps)
    return message


def _to_numpy(value: Any, dtype: Any) -> Any:
    import numpy as np  # late: only messages with fixed-size arrays need it

    return np.array(value, dtype=dtype)


def _stamp_setter(holder: Any, name: str) -> SetStamp:
    return lambda now: setattr(holder, name, now)
