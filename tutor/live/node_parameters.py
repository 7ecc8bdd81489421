"""The parameters of every node: read when it appears, when it reports a change, and on demand."""

from __future__ import annotations

import array
import asyncio
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from tutor.live.protocol import SetParameter
from tutor.live.updates import NodeParameters, SetOutcome
from tutor.ros.observer import Observer
from tutor.ros.parameter_events import watch_changes
from tutor.ros.parameters import get_parameters, set_parameters
from tutor.ros_model import Graph

LIMIT_S = 3.0
"""How long a node may take to answer, in seconds."""

RETRY_S = 5.0
"""A node that did not answer is asked again after this time, in seconds: it may spin by then."""


class ParameterWatch:
    """Sends a NodeParameters for each node with parameter services, whenever they may have changed."""

    def __init__(self, observer: Observer, send: Callable[[NodeParameters], object]) -> None:
        self._observer = observer
        self._send = send
        self._nodes: frozenset[str] = frozenset()
        self._asking: dict[str, asyncio.Task[None]] = {}
        self._changed: set[str] = set()
        self._retry_at: dict[str, float] = {}
        watch_changes(observer, self.ask)

    def update_graph(self, graph: Graph) -> None:
        """Ask nodes that have appeared."""
        nodes = frozenset(graph.parameter_nodes)
        new, self._nodes = nodes - self._nodes, nodes
        self._retry_at = {node: due for node, due in self._retry_at.items() if node in nodes}
        for node in new:
            self.ask(node)

    def ask(self, node: str) -> None:
        """Ask one node; where it is being asked already, once more afterwards."""
        if node not in self._nodes:
            return
        if node in self._asking:
            self._changed.add(node)
            return
        self._asking[node] = asyncio.create_task(self._ask(node))

    def ask_all(self) -> None:
        """Ask every node."""
        for node in self._nodes:
            self.ask(node)

    def retry_silent(self) -> None:
        """Ask nodes again that did not answer `RETRY_S` ago."""
        for node, due in list(self._retry_at.items()):
            if time.monotonic() >= due:
                self.ask(node)

    async def set(self, request: SetParameter) -> SetOutcome:
        """Set one parameter. Gives the node's answer, or that none came."""
        answer = await set_parameters(
            self._observer,
            request.node,
            {request.name: request.value},
            atomic=False,
            limit_s=LIMIT_S,
            types={request.name: request.type},
        )
        return SetOutcome(
            id=request.id,
            node=request.node,
            name=request.name,
            value=request.value,
            answered=answer.answered,
            accepted=answer.successful,
            reason=answer.reason,
            at=answer.asked_at,
            took_s=answer.took_s,
        )

    async def _ask(self, node: str) -> None:
        try:
            found = await get_parameters(self._observer, [node], LIMIT_S)
            self._retry_at.pop(node, None)
            if found is None:
                self._retry_at[node] = time.monotonic() + RETRY_S
            parameters = tuple(replace(each, value=_plain(each.value)) for each in found or ())
            self._send(NodeParameters(node, found is not None, parameters))
        finally:
            del self._asking[node]
        if node in self._changed:
            self._changed.discard(node)
            self.ask(node)


def _plain(value: Any) -> Any:
    """As JSON can hold it."""
    if isinstance(value, (array.array, list, tuple)):
        return [_plain(item) for item in value]
    return value[0] if isinstance(value, bytes) else value
