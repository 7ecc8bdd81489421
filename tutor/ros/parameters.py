"""Parameters of the learner's nodes, asked for and set over the parameter services."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable, Mapping
from typing import Any

from tutor.judge.trace import SetAnswer
from tutor.ros.messages import cut, interface_class
from tutor.ros.observer import Observer
from tutor.ros_model import PARAMETER_TYPES, Parameter

_FIELDS = (
    None,
    "bool_value",
    "integer_value",
    "double_value",
    "string_value",
    "byte_array_value",
    "bool_array_value",
    "integer_array_value",
    "double_array_value",
    "string_array_value",
)


MOST_PARAMETERS, MOST_ELEMENTS = 500, 1000
"""This many parameters of a node are asked for, and this many elements of an array are kept. Texts are cut, too."""


async def get_parameters(observer: Observer, nodes: Iterable[str], limit_s: float) -> tuple[Parameter, ...] | None:
    """The parameters of all `nodes` that answer within `limit_s` seconds; None where none does."""
    answers = await asyncio.gather(*(_ask_one(observer, node, limit_s) for node in dict.fromkeys(nodes)))
    if all(answer is None for answer in answers):
        return None
    return tuple(parameter for answer in answers if answer is not None for parameter in answer)


async def set_parameters(
    observer: Observer,
    node: str,
    values: Mapping[str, Any],
    *,
    atomic: bool,
    limit_s: float,
    types: Mapping[str, str] | None = None,
) -> SetAnswer:
    """Set parameters of one node in one request. Python floats are doubles, ints integers, as on the command line.

    `types` names the types of those values that do not tell it themselves, such as an empty list.
    """
    verb, kind = (
        ("set_parameters_atomically", "SetParametersAtomically") if atomic else ("set_parameters", "SetParameters")
    )
    wanted = [_message(name, value, (types or {}).get(name)) for name, value in values.items()]
    asked = time.time()
    answer = await observer.call(f"{node}/{verb}", f"rcl_interfaces/srv/{kind}", {"parameters": wanted}, limit_s)
    if answer is None:
        return SetAnswer(values, False, False, "", asked, time.time())
    results = [answer.result] if atomic else answer.results
    return SetAnswer(
        values,
        True,
        all(result.successful for result in results) and bool(results),
        cut("; ".join(result.reason for result in results if result.reason)),
        asked,
        time.time(),
    )


async def _ask_one(observer: Observer, node: str, limit_s: float) -> tuple[Parameter, ...] | None:
    listed = await observer.call(f"{node}/list_parameters", "rcl_interfaces/srv/ListParameters", {}, limit_s)
    if listed is None:
        return None
    names = list(listed.result.names)[:MOST_PARAMETERS]
    if not names:
        return ()
    values, described = await asyncio.gather(
        observer.call(f"{node}/get_parameters", "rcl_interfaces/srv/GetParameters", {"names": names}, limit_s),
        observer.call(
            f"{node}/describe_parameters", "rcl_interfaces/srv/DescribeParameters", {"names": names}, limit_s
        ),
    )
    if described is None:
        return None
    # A declared parameter without a value makes get_parameters answer with nothing at all; ask one by one then.
    if values is None or len(values.values) != len(names):
        singly = await asyncio.gather(
            *(
                observer.call(f"{node}/get_parameters", "rcl_interfaces/srv/GetParameters", {"names": [name]}, limit_s)
                for name in names
            )
        )
        held = [one.values[0] if one is not None and one.values else None for one in singly]
    else:
        held = list(values.values)
    return tuple(
        _parameter(node, name, value, descriptor)
        for name, value, descriptor in zip(names, held, described.descriptors, strict=False)
    )


def _parameter(node: str, name: str, value: Any, descriptor: Any) -> Parameter:
    kind = value.type if value is not None and value.type else descriptor.type
    field = _FIELDS[value.type] if value is not None else None
    ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
    return Parameter(
        node=node,
        name=name,
        type=PARAMETER_TYPES[kind],
        value=_kept(getattr(value, field)) if field else None,
        read_only=descriptor.read_only,
        minimum=float(ranges[0].from_value) if ranges else None,
        maximum=float(ranges[0].to_value) if ranges else None,
    )


def _kept(value: Any) -> Any:
    if isinstance(value, str):
        return cut(value)
    return value[:MOST_ELEMENTS] if hasattr(value, "__len__") else value


def _message(name: str, value: Any, type_name: str | None = None) -> Any:
    holder = interface_class("rcl_interfaces/msg/ParameterValue")()
    holder.type = _kind_of(value) if type_name is None else PARAMETER_TYPES.index(type_name)
    if type_name == "byte array":
        value = [bytes([item]) for item in value]
    setattr(holder, str(_FIELDS[holder.type]), value)
    parameter = interface_class("rcl_interfaces/msg/Parameter")()
    parameter.name = name
    parameter.value = holder
    return parameter


def _kind_of(value: Any) -> int:
    # bool before int: a bool is an int in Python, but not in ROS.
    for kind, python_type in ((1, bool), (2, int), (3, float), (4, str)):
        if isinstance(value, python_type):
            return kind
    raise TypeError(f"no parameter type for {value!r}")
