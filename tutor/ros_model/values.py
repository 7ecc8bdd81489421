"""Parses text typed by a learner as a value of a ROS type, or says in plain words what is wrong with it. Pure."""

from __future__ import annotations

import math
import re
from typing import Any

import yaml

from tutor.ros_model.parameter import Parameter

_INTEGER = re.compile(r"(u?)int(8|16|32|64)")
_ARRAY = re.compile(r"sequence<(?P<item>.+?)(, (?P<most>\d+))?>|(?P<fixed>.+)\[(?P<length>\d+)\]")
_STRING = re.compile(r"w?string(<(\d+)>)?")
_BOOLEANS = {"true": True, "false": False}
_BYTE_TYPES = ("byte", "octet", "char")
_FLOAT_TYPES = ("float", "double", "float32", "float64", "long double")

_PARAMETER_FIELD_TYPES = {
    "boolean": "boolean",
    "integer": "int64",
    "double": "double",
    "string": "string",
    "byte array": "sequence<octet>",
    "boolean array": "sequence<boolean>",
    "integer array": "sequence<int64>",
    "double array": "sequence<double>",
    "string array": "sequence<string>",
}


def parse_value(type_name: str, text: str) -> Any:
    """Parse a text as a value of a field type, such as `int64`, `sequence<double, 3>` or `string`.

    Raises ValueError with one line that says what is wrong.
    """
    if found := _ARRAY.fullmatch(type_name):
        return _parse_array(found, text)
    if _STRING.fullmatch(type_name):
        return _parse_string(type_name, text)
    text = text.strip()
    if type_name in ("boolean", "bool"):
        if text.lower() not in _BOOLEANS:
            raise ValueError("Write true or false.")
        return _BOOLEANS[text.lower()]
    if type_name in _FLOAT_TYPES:
        return _parse_float(text)
    return _parse_integer(type_name, text)


def parse_parameter(parameter: Parameter, text: str) -> tuple[str, Any]:
    """Return the type and value to set a parameter to. If it has no type yet, infer one as `ros2 param set` does.

    Raises ValueError with a one-line message. Does not check the range: accepting the value is up to the node.
    """
    if parameter.type in _PARAMETER_FIELD_TYPES:
        return parameter.type, parse_value(_PARAMETER_FIELD_TYPES[parameter.type], text)
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError:
        value = text
    for name, kind in (("boolean", bool), ("integer", int), ("double", float)):
        if type(value) is kind:
            return name, value
    return "string", text


def format_value(value: Any) -> str:
    """Format a value as a learner would type it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_quote(item) if isinstance(item, str) else format_value(item) for item in value)}]"
    return str(value)


def _quote(text: str) -> str:
    # YAML reads a double-quoted string back unchanged.
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def _parse_integer(type_name: str, text: str) -> int:
    try:
        value = int(text, 0)
    except ValueError:
        raise ValueError(f"Write a whole number, such as 3 (the type is {type_name}).") from None
    if type_name in _BYTE_TYPES:
        lowest, highest = 0, 255
    elif found := _INTEGER.fullmatch(type_name):
        bits = int(found[2])
        lowest, highest = (0, 2**bits - 1) if found[1] else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    else:
        raise ValueError(f"A field of type {type_name} cannot be filled in here.")
    if not lowest <= value <= highest:
        raise ValueError(f"A {type_name} is from {lowest} to {highest}.")
    return value


def _parse_float(text: str) -> float:
    try:
        return float(text.replace(".inf", "inf").replace(".nan", "nan"))  # as YAML writes them
    except ValueError:
        raise ValueError("Write a number, such as 2.5.") from None


def _parse_string(type_name: str, text: str) -> str:
    found = _STRING.fullmatch(type_name)
    most = int(found[2]) if found and found[2] else math.inf
    if len(text) > most:
        raise ValueError(f"At most {most} characters are allowed, but there are {len(text)}.")
    return text


def _parse_array(found: re.Match[str], text: str) -> list[Any]:
    try:
        items = yaml.safe_load(text) if text.strip() else []
    except yaml.YAMLError:
        items = None
    if not isinstance(items, list):
        raise ValueError("Write a list in brackets, such as [1, 2, 3].")
    item_type = found["item"] or found["fixed"]
    values = [parse_value(item_type, item if isinstance(item, str) else format_value(item)) for item in items]
    if found["length"] and len(values) != int(found["length"]):
        raise ValueError(f"Exactly {found['length']} values are needed, but there are {len(values)}.")
    if found["most"] and len(values) > int(found["most"]):
        raise ValueError(f"At most {found['most']} values are allowed, but there are {len(values)}.")
    return values
