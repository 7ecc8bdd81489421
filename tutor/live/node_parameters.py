"""Reads the parameters of every node: when it appears, when it reports a change, and on demand."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from dataclasses import replace

from tutor.live.protocol import SetParameter
from tutor.live.updates import NodeParameters, SetOutcome
from tutor.ros.graph import parameter_event_publishers
from tutor.ros.messages import plain_value
from tutor.ros.observer import Observer
from tutor.ros.parameter_events import watch_changes
from tutor.ros.parameters import get_parameters, set_parameters
from tutor.ros_model import Graph

LIMIT_S = 3.0
"""Timeout for a response of a node."""

RETRY_S = 5.0
"""Delay before retrying a node that did not respond: it may be spinning by then."""


class ParameterWatch:
    """Sends a NodeParameters update for each node with parameter services whenever its parameters may have changed."""

    def __init__(self, observer: Observer, send: Callable[[NodeParameters], object]) -> None:
        self._observer = observer
        self._send = send
        self._nodes: frozenset[str] = frozenset()
        self._publishers: frozenset[tuple[str, bytes]] = frozenset()
        self._refreshing: dict[str, asyncio.Task[None]] = {}
        self._changed_meanwhile: set[str] = set()
        self._retry_at: dict[str, float] = {}
        watch_changes(observer, self.refresh)

    def update_graph(self, graph: Graph) -> None:
        """Read the parameters of new nodes, including those that have replaced one of the same name."""
        nodes, publishers = frozenset(graph.parameter_nodes), parameter_event_publishers(self._observer.node)
        new = (nodes - self._nodes) | {node for node, _ in publishers ^ self._publishers}
        self._nodes, self._publishers = nodes, publishers
        self._retry_at = {node: due for node, due in self._retry_at.items() if node in nodes}
        for node in new:
            self.refresh(node)

    def refresh(self, node: str) -> None:
        """Read the parameters of one node. If that is already in progress, read them once more afterwards."""
        if node not in self._nodes:
            return
        if node in self._refreshing:
            self._changed_meanwhile.add(node)
            return
        self._refreshing[node] = asyncio.create_task(self._refresh(node))

    def refresh_all(self) -> None:
        """Read the parameters of every node."""
        for node in self._nodes:
            self.refresh(node)

    def retry_unresponsive(self) -> None:
        """Retry nodes that did not respond `RETRY_S` ago."""
        for node, due in list(self._retry_at.items()):
            if time.monotonic() >= due:
                self.refresh(node)

    async def set(self, request: SetParameter) -> SetOutcome:
        """Set one parameter. Return the node's response, or that there was none."""
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

    async def _refresh(self, node: str) -> None:
        try:
            found = await get_parameters(self._observer, [node], LIMIT_S)
            self._retry_at.pop(node, None)
            if found is None:
                self._retry_at[node] = time.monotonic() + RETRY_S
            parameters = tuple(replace(parameter, value=plain_value(parameter.value)) for parameter in found or ())
            self._send(NodeParameters(node, found is not None, parameters))
        finally:
            del self._refreshing[node]
        if node in self._changed_meanwhile:
            self._changed_meanwhile.discard(node)
            self.refresh(node)
