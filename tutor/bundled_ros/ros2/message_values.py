"""Messages filled from YAML values, with the conversions that rosidl_runtime_py makes."""

from __future__ import annotations

import array
import importlib
from collections.abc import Callable, Mapping
from typing import Any

from tutor.bundled_ros.ros2.yaml_errors import yaml_problem
from tutor.errors import CommandError

SetStamp = Callable[[Any], None]
"""Takes the time of now, as builtin_interfaces/msg/Time."""


def message_from_yaml(kind: Any, text: str, *, failed: str) -> Any:
    """A message of the class `kind` with the values of a YAML text; what it does not name has its default.

    Raises CommandError; `failed` is what it says of a value that does not fit, with `{}` for the error.
    """
    import yaml

    message = kind()
    try:
        set_fields(message, yaml.safe_load(text))
    except yaml.YAMLError as error:
        raise CommandError(f"The passed value is not YAML: {yaml_problem(error)}") from error
    except Exception as error:  # whatever the setter of a field raises, its text says what is wrong with the value
        raise CommandError(failed.format(error)) from error
    return message


def set_fields(message: Any, values: Any, *, stamps: bool = False) -> list[SetStamp]:
    """Set the fields of `message` that `values`, a mapping, names; others keep their defaults.

    A value becomes what the field's type makes of it: `int(1.5)` is 1. With `stamps`, a header may be `auto` and a time
    `now`: what is returned sets them. Raises what the conversion raises (AttributeError, TypeError, ValueError and the
    like) with the message that ros2cli shows.
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
            setters.append(_setter(field, "stamp"))
        elif stamps and value == "now" and kind == "builtin_interfaces.msg._time.Time":
            setters.append(_setter(message, name))
        else:
            setattr(message, name, _converted(field, value, slots.get(name), stamps, setters))
    return setters


def is_message(value: Any) -> bool:
    """Whether it is of a ROS type, and not of one of Python's or numpy's."""
    return hasattr(value, "get_fields_and_field_types")


def _converted(field: Any, value: Any, slot: Any, stamps: bool, setters: list[SetStamp]) -> Any:
    if isinstance(field, array.array):
        return array.array(field.typecode, value)
    if type(field).__module__ == "numpy":
        return _as_numpy(value, field.dtype)
    if is_message(field):
        nested = type(field)()
        setters += set_fields(nested, value, stamps=stamps)
        return nested
    try:
        converted = value if type(value) is type(field) else type(field)(value)
    except TypeError:  # rosidl_runtime_py takes whatever cannot be converted for a nested message, and says so
        setters += set_fields(converted := type(field)(), value, stamps=stamps)
    element = getattr(slot, "value_type", None)
    if isinstance(converted, list) and hasattr(element, "namespaced_name"):
        return [_element(element, each, stamps, setters) for each in converted]
    return converted


def _element(kind: Any, values: Any, stamps: bool, setters: list[SetStamp]) -> Any:
    *where, name = kind.namespaced_name()
    message = getattr(importlib.import_module(".".join(where)), name)()
    setters += set_fields(message, values, stamps=stamps)
    return message


def _as_numpy(value: Any, dtype: Any) -> Any:
    import numpy as np  # late: only messages with arrays of a fixed length need it

    return np.array(value, dtype=dtype)


def _setter(holder: Any, name: str) -> SetStamp:
    return lambda now: setattr(holder, name, now)
