"""Service calls: any number at a time, each with a timeout and cancellable."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from tutor.errors import UnknownType
from tutor.live.protocol import Call
from tutor.live.topics import MAX_TEXT
from tutor.live.updates import CallOutcome, RequestForm
from tutor.ros.fields import fill, leaf_fields
from tutor.ros.interfaces import interface_class
from tutor.ros.messages import truncate
from tutor.ros.observer import Observer
from tutor.ros.yaml_format import to_yaml

CANCELLED = "cancelled"


def describe(type_name: str) -> RequestForm:
    """Return the form of a message type, or of a service type's request."""
    try:
        found = interface_class(type_name)
        return RequestForm(type_name, tuple(leaf_fields(found() if "/msg/" in type_name else found.Request())))
    except UnknownType:
        return RequestForm(type_name, problem=f"This ROS does not have the type {type_name}.")


class ServiceCalls:
    """Manages the calls in progress. Each one sends a CallOutcome when it ends, for whatever reason."""

    def __init__(self, observer: Observer, send: Callable[[CallOutcome], object]) -> None:
        self._observer = observer
        self._send = send
        self._running: dict[int, asyncio.Task[None]] = {}

    def begin(self, call: Call) -> None:
        """Start a service call."""
        self._running[call.id] = asyncio.create_task(self._run(call))

    def cancel(self, id: int) -> None:
        """Cancel a call, if it is still in progress."""
        if task := self._running.get(id):
            task.cancel()

    async def _run(self, call: Call) -> None:
        at, began = time.time(), time.perf_counter()
        text, problem = None, ""
        try:
            text, problem = await self._call(call)
        except asyncio.CancelledError:
            problem = CANCELLED
        finally:
            del self._running[call.id]
        took_s = time.perf_counter() - began
        self._send(CallOutcome(call.id, call.service, call.request, text, problem, at, took_s))

    async def _call(self, call: Call) -> tuple[str | None, str]:
        try:
            request = fill(interface_class(call.type).Request(), call.request)
        except UnknownType:
            return None, f"This ROS does not have the type {call.type}."
        except ValueError as error:
            return None, str(error)
        answer = await self._observer.call(call.service, call.type, request, call.limit_s)
        if answer is not None:
            return truncate(to_yaml(answer), MAX_TEXT), ""
        if not self._is_offered(call.service):
            return None, "no answer: no node offers this service any more"
        return None, f"no answer within {call.limit_s:g} s: does the node spin, and does its callback return?"

    def _is_offered(self, service: str) -> bool:
        return any(name == service for name, _ in self._observer.node.get_service_names_and_types())
