"""Reads and sets parameters of the learner's nodes through the parameter services."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Iterable, Mapping
from typing import Any

from rclpy.parameter import Parameter as ParameterMessage

from tutor.judge.trace import SetAnswer
from tutor.ros.interfaces import interface_class
from tutor.ros.messages import is_array, text_bytes, truncate
from tutor.ros.observer import AnswerTooLarge, Observer
from tutor.ros_model import PARAMETER_TYPES, Parameter

MAX_PARAMETERS, MAX_ELEMENTS = 500, 1000
"""Limits on the parameters read from a node, and on the elements kept of an array. Strings are cut, too."""

LONGEST_NAME = 1000

MAX_BYTES = 64_000_000
"""Once this much of a node's strings and arrays has been received, no more of them are requested."""

TOO_LARGE = (0, "(too large to be read)")
"""Type and value shown for a parameter that is too large to read."""

_FIXED_SIZE_TYPES = frozenset((1, 2, 3))
"""Type numbers of fixed-size values: bool, integer, double."""

RESEND_S = 1.0
"""A request for parameters that was not answered within this time is sent again."""

_LARGE_BYTES = 1_000_000
_ELEMENT_BYTES = 8
"""Of an array of numbers, and the length of a string; those of bytes and booleans are counted as numbers."""


async def get_parameters(observer: Observer, nodes: Iterable[str], limit_s: float) -> tuple[Parameter, ...] | None:
    """Return the parameters of all `nodes` that respond within `limit_s` seconds; None if none does."""
    answers = await asyncio.gather(*(_get_node_parameters(observer, node, limit_s) for node in dict.fromkeys(nodes)))
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
    """Set parameters of one node in one request. Python floats become doubles, ints integers, as on the command line.

    `types` gives the type of values that do not show it themselves, such as an empty list.
    """
    verb, kind = (
        ("set_parameters_atomically", "SetParametersAtomically") if atomic else ("set_parameters", "SetParameters")
    )
    parameters = [_parameter_message(name, value, (types or {}).get(name)) for name, value in values.items()]
    requested_at = time.time()
    try:
        answer = await observer.call(
            f"{node}/{verb}", f"rcl_interfaces/srv/{kind}", {"parameters": parameters}, limit_s
        )
    except AnswerTooLarge:
        return SetAnswer(values, True, False, TOO_LARGE[1], requested_at, time.time())
    if answer is None:
        return SetAnswer(values, False, False, "", requested_at, time.time())
    results = [answer.result] if atomic else answer.results
    return SetAnswer(
        values,
        True,
        all(result.successful for result in results) and bool(results),
        truncate("; ".join(result.reason for result in results if result.reason)),
        requested_at,
        time.time(),
    )


async def _get_node_parameters(observer: Observer, node: str, limit_s: float) -> tuple[Parameter, ...] | None:
    try:
        listed = await observer.call(
            f"{node}/list_parameters", "rcl_interfaces/srv/ListParameters", {}, limit_s, resend_s=RESEND_S
        )
    except AnswerTooLarge:
        return ()
    if listed is None:
        return None
    names = [name for name in listed.result.names[:MAX_PARAMETERS] if len(name) <= LONGEST_NAME]
    if not names:
        return ()
    request = {"names": names}
    try:
        described = await observer.call(
            f"{node}/describe_parameters", "rcl_interfaces/srv/DescribeParameters", request, limit_s, resend_s=RESEND_S
        )
        if described is None:
            return None
        descriptors = dict(zip(names, described.descriptors, strict=False))
    except AnswerTooLarge:
        descriptors = {name: interface_class("rcl_interfaces/msg/ParameterDescriptor")() for name in names}
    fixed_size = [name for name, descriptor in descriptors.items() if descriptor.type in _FIXED_SIZE_TYPES]
    values = _ValueReader(observer, node, limit_s)
    await values.read(fixed_size)
    await values.read_in_batches([name for name in descriptors if name not in set(fixed_size)])
    return tuple(_parameter(node, name, values.found.get(name), descriptor) for name, descriptor in descriptors.items())


class _ValueReader:
    """Reads the values of a node's parameters without ever receiving much data at once.

    A response holds all requested values and cannot be received in part. So parameters of fixed-size types are read
    together. Of the others we request one first, and then more at a time for as long as they turn out to be small.
    """

    def __init__(self, observer: Observer, node: str, limit_s: float) -> None:
        self.found: dict[str, Any] = {}
        self._observer = observer
        self._node = node
        self._limit_s = limit_s

    async def read_in_batches(self, names: list[str]) -> None:
        """Read parameters of any size, and stop after `MAX_BYTES`."""
        batch_size, received = 1, 0
        while names:
            batch, names = names[:batch_size], names[batch_size:]
            if received > MAX_BYTES:
                self.found.update(dict.fromkeys(batch, TOO_LARGE))
                continue
            size = await self.read(batch, large=True)
            batch_size = 1 if size > _LARGE_BYTES else 2 * batch_size
            received += size

    async def read(self, names: list[str], *, large: bool = False) -> int:
        """Read these parameters in one request, or one by one if that fails. Return the size received, in bytes."""
        if not names:
            return 0
        service, type_name = f"{self._node}/get_parameters", "rcl_interfaces/srv/GetParameters"
        try:
            resend_s = math.inf if large else RESEND_S
            answer = await self._observer.call(
                service, type_name, {"names": names}, self._limit_s, large=large, resend_s=resend_s
            )
        except AnswerTooLarge:
            # Wait until the rest of it is gone, so that it is not taken for part of the next response.
            await self._observer.wait_while_paused(self._limit_s)
            if len(names) > 1:
                return sum([await self.read([name], large=large) for name in names])
            self.found[names[0]] = TOO_LARGE
            return MAX_BYTES // 4
        values = list(answer.values) if answer is not None else []
        # A parameter that is declared without a value makes get_parameters return nothing at all: read one by one then.
        if len(values) != len(names) and len(names) > 1:
            return sum(await asyncio.gather(*(self.read([name], large=large) for name in names)))
        size = sum(_value_bytes(value) for value in values)
        self.found.update({name: _read_value(value) for name, value in zip(names, values, strict=False)})
        if size > _LARGE_BYTES:
            self._observer.discard_client(service, type_name)
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


def _content(value: Any) -> Any:
    """Return the field of a ParameterValue that its type names; None if it is not set."""
    type_name = PARAMETER_TYPES[value.type].replace("boolean", "bool").replace(" ", "_")
    return getattr(value, f"{type_name}_value", None)


def _read_value(value: Any) -> tuple[int, Any]:
    """Return the type number and the value, cut to the limits."""
    content = _content(value)
    if isinstance(content, str):
        return value.type, truncate(content)
    return value.type, content[:MAX_ELEMENTS] if is_array(content) else content


def _value_bytes(value: Any) -> int:
    """Return about how many bytes the value took when it was received."""
    content = _content(value)
    if isinstance(content, str):
        return text_bytes(content)
    if not is_array(content):
        return _ELEMENT_BYTES
    return _ELEMENT_BYTES * len(content) + sum(text_bytes(item) for item in content if isinstance(item, str))


def _parameter_message(name: str, value: Any, type_name: str | None) -> Any:
    if type_name == "byte array":
        value = [bytes([item]) for item in value]
    kind = None if type_name is None else ParameterMessage.Type(PARAMETER_TYPES.index(type_name))
    return ParameterMessage(name, kind, value).to_parameter_msg()
