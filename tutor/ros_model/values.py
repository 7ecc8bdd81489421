"""Text that a learner typed, as a value of a ROS type; and what is wrong with it, in plain words. Pure."""

from __future__ import annotations

import math
import re
from typing import Any

import yaml

from tutor.ros_model.parameter import Parameter

_INTEGER = re.compile(r"(u?)int(8|16|32|64)")
_ARRAY = re.compile(r"sequence<(?P<of>.+?)(, (?P<most>\d+))?>|(?P<fixed>.+)\[(?P<length>\d+)\]")
_STRING = re.compile(r"w?string(<(\d+)>)?")
_BOOLEANS = {"true": True, "false": False}
_ONE_BYTE = ("byte", "octet", "char")
_FLOATS = ("float", "double", "float32", "float64", "long double")

_OF_PARAMETERS = {
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
    """The value that a text means for a field of this type, such as `int64`, `sequence<double, 3>` or `string`.

    Raises ValueError with one line that says what is wrong.
    """
    if found := _ARRAY.fullmatch(type_name):
        return _array(found, text)
    if _STRING.fullmatch(type_name):
        return _string(type_name, text)
    text = text.strip()
    if type_name in ("boolean", "bool"):
        if text.lower() not in _BOOLEANS:
            raise ValueError("Write true or false.")
        return _BOOLEANS[text.lower()]
    if type_name in _FLOATS:
        return _float(text)
    return _integer(type_name, text)


def parse_parameter(parameter: Parameter, text: str) -> tuple[str, Any]:
    """The type and value to set a parameter to. One that has no type yet takes the text's, as `ros2 param set` does.

    Raises ValueError with one line. A range is not looked at: the node itself is to say what it thinks of the value.
    """
    if parameter.type in _OF_PARAMETERS:
        return parameter.type, parse_value(_OF_PARAMETERS[parameter.type], text)
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError:
        value = text
    for name, kind in (("boolean", bool), ("integer", int), ("double", float)):
        if type(value) is kind:
            return name, value
    return "string", text


def format_value(value: Any) -> str:
    """A value as a learner would type it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_quoted(item) if isinstance(item, str) else format_value(item) for item in value)}]"
    return str(value)


def _quoted(text: str) -> str:
    # Double quotes are read back by YAML as they stand.
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def _integer(type_name: str, text: str) -> int:
    try:
        value = int(text, 0)
    except ValueError:
        raise ValueError(f"Write a whole number, such as 3 (the type is {type_name}).") from None
    if type_name in _ONE_BYTE:
        lowest, highest = 0, 255
    elif found := _INTEGER.fullmatch(type_name):
        bits = int(found[2])
        lowest, highest = (0, 2**bits - 1) if found[1] else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    else:
        raise ValueError(f"A field of type {type_name} cannot be filled in here.")
    if not lowest <= value <= highest:
        raise ValueError(f"A {type_name} is from {lowest} to {highest}.")
    return value


def _float(text: str) -> float:
    try:
        return float(text.replace(".inf", "inf").replace(".nan", "nan"))  # as YAML writes them
    except ValueError:
        raise ValueError("Write a number, such as 2.5.") from None


def _string(type_name: str, text: str) -> str:
    found = _STRING.fullmatch(type_name)
    most = int(found[2]) if found and found[2] else math.inf
    if len(text) > most:
        raise ValueError(f"At most {most} characters: this has {len(text)}.")
    return text


def _array(found: re.Match[str], text: str) -> list[Any]:
    try:
        given = yaml.safe_load(text) if text.strip() else []
    except yaml.YAMLError:
        given = None
    if not isinstance(given, list):
        raise ValueError("Write a list in brackets, such as [1, 2, 3].")
    of = found["of"] or found["fixed"]
    values = [parse_value(of, item if isinstance(item, str) else format_value(item)) for item in given]
    if found["length"] and len(values) != int(found["length"]):
        raise ValueError(f"Exactly {found['length']} values: these are {len(values)}.")
    if found["most"] and len(values) > int(found["most"]):
        raise ValueError(f"At most {found['most']} values: these are {len(values)}.")
    return values
