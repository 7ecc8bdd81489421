"""Parameters of the learner's nodes, asked for and set over the parameter services."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable, Mapping
from typing import Any

from tutor.judge.trace import SetAnswer
from tutor.ros.messages import interface_class, truncate
from tutor.ros.observer import AnswerTooLarge, Observer
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

LONGEST_NAME = 1000

MOST_BYTES = 64_000_000
"""No more than this is received of the values of a node's texts and arrays, one after the other."""

TOO_LARGE = (0, "(too large to be read)")
"""In place of a type and a value: of a parameter that is not read."""

_SMALL = frozenset((1, 2, 3))
"""The types whose values have a fixed size."""

_LARGE = 1_000_000
_ELEMENT_BYTES = 8


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
    try:
        answer = await observer.call(f"{node}/{verb}", f"rcl_interfaces/srv/{kind}", {"parameters": wanted}, limit_s)
    except AnswerTooLarge:
        return SetAnswer(values, True, False, TOO_LARGE[1], asked, time.time())
    if answer is None:
        return SetAnswer(values, False, False, "", asked, time.time())
    results = [answer.result] if atomic else answer.results
    return SetAnswer(
        values,
        True,
        all(result.successful for result in results) and bool(results),
        truncate("; ".join(result.reason for result in results if result.reason)),
        asked,
        time.time(),
    )


async def _ask_one(observer: Observer, node: str, limit_s: float) -> tuple[Parameter, ...] | None:
    try:
        listed = await observer.call(f"{node}/list_parameters", "rcl_interfaces/srv/ListParameters", {}, limit_s)
    except AnswerTooLarge:
        return ()
    if listed is None:
        return None
    names = [name for name in listed.result.names[:MOST_PARAMETERS] if len(name) <= LONGEST_NAME]
    if not names:
        return ()
    asked = {"names": names}
    try:
        described = await observer.call(
            f"{node}/describe_parameters", "rcl_interfaces/srv/DescribeParameters", asked, limit_s
        )
        if described is None:
            return None
        descriptors = dict(zip(names, described.descriptors, strict=False))
    except AnswerTooLarge:
        descriptors = {name: interface_class("rcl_interfaces/msg/ParameterDescriptor")() for name in names}
    small = [name for name, descriptor in descriptors.items() if descriptor.type in _SMALL]
    values = _Values(observer, node, limit_s)
    await values.ask(small)
    await values.ask_in_turn([name for name in descriptors if name not in set(small)])
    return tuple(_parameter(node, name, values.found.get(name), descriptor) for name, descriptor in descriptors.items())


class _Values:
    """The values of a node's parameters, asked for without ever having much of them at a time.

    One answer holds all that were asked for, and cannot be had in part. So those that are small by their type are asked
    for together; of the others a few, and more only while they are small, too.
    """

    def __init__(self, observer: Observer, node: str, limit_s: float) -> None:
        self.found: dict[str, Any] = {}
        self._observer = observer
        self._node = node
        self._limit_s = limit_s

    async def ask_in_turn(self, names: list[str]) -> None:
        """Ask for parameters of any size; from `MOST_BYTES` on, no more of them."""
        at_once, received = 1, 0
        while names:
            some, names = names[:at_once], names[at_once:]
            if received > MOST_BYTES:
                self.found.update(dict.fromkeys(some, TOO_LARGE))
                continue
            size = await self.ask(some, large=True)
            at_once = 1 if size > _LARGE else 2 * at_once
            received += size

    async def ask(self, names: list[str], *, large: bool = False) -> int:
        """Ask for these parameters in one request; gives the size of the answer, in bytes."""
        if not names:
            return 0
        service, type_name = f"{self._node}/get_parameters", "rcl_interfaces/srv/GetParameters"
        try:
            answer = await self._observer.call(service, type_name, {"names": names}, self._limit_s, large=large)
        except AnswerTooLarge:
            await self._observer.wait_while_paused(self._limit_s)  # what comes of it meanwhile is none of the next one
            if len(names) > 1:
                return sum([await self.ask([name], large=large) for name in names])
            self.found[names[0]] = TOO_LARGE
            return MOST_BYTES // 4
        values = list(answer.values) if answer is not None else []
        # A declared parameter without a value makes get_parameters answer with nothing at all; ask one by one then.
        if len(values) != len(names) and len(names) > 1:
            return sum(await asyncio.gather(*(self.ask([name], large=large) for name in names)))
        size = sum(_size(value) for value in values)
        self.found.update({name: _value(value) for name, value in zip(names, values, strict=False)})
        if size > _LARGE:
            self._observer.forget(service, type_name)
        return size


def _parameter(node: str, name: str, found: tuple[int, Any] | None, descriptor: Any) -> Parameter:
    kind, value = found or (0, None)
    ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
    return Parameter(
        node=node,
        name=name,
        type=PARAMETER_TYPES[kind or descriptor.type],
        value=value,
        read_only=descriptor.read_only,
        minimum=float(ranges[0].from_value) if ranges else None,
        maximum=float(ranges[0].to_value) if ranges else None,
    )


def _value(value: Any) -> tuple[int, Any]:
    """A value with the number of its type, cut to what is kept of it."""
    field = _FIELDS[value.type]
    held = getattr(value, field) if field else None
    if isinstance(held, str):
        return value.type, truncate(held)
    return value.type, held[:MOST_ELEMENTS] if held is not None and hasattr(held, "__len__") else held


def _size(value: Any) -> int:
    field = _FIELDS[value.type]
    held = getattr(value, field) if field else None
    return _ELEMENT_BYTES * len(held) if held is not None and hasattr(held, "__len__") else _ELEMENT_BYTES


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
