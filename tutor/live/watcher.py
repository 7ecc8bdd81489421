"""Watches one domain and carries out the app's requests there."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from typing import Any

from tutor.live.calls import ServiceCalls, describe
from tutor.live.ghosts import without_ghosts
from tutor.live.node_parameters import ParameterWatch
from tutor.live.protocol import (
    Call,
    Cancel,
    Clear,
    Describe,
    Follow,
    Plot,
    Publish,
    Ready,
    Refresh,
    SetParameter,
    SetVisible,
    StopPublishing,
    Unfollow,
    Update,
    WatcherError,
    WatcherRequest,
)
from tutor.live.publishing import Publishing
from tutor.live.topics import FollowedTopics
from tutor.ros.graph import graph_fingerprint, read_graph
from tutor.ros.manual_publisher import ManualPublisher
from tutor.ros.observer import Observer
from tutor.ros.raw_subscription import RawSubscription
from tutor.ros_model import Graph

UPDATE_INTERVAL_S = 0.2
"""Interval of topic updates, however fast the topics are."""

GRAPH_CHECK_INTERVAL_S = 0.5
GRAPH_READ_INTERVAL_S = 2.0
"""Intervals of the cheap check for graph changes, and of a full read even if that check finds none."""


class Watcher:
    """Our participant in the domain. `send` receives every update, on the event loop's thread."""

    def __init__(self, domain_id: int, send: Callable[[Update], object]) -> None:
        self._send = send
        self._observer = Observer(domain_id, guarded=False)
        self._raw_subscription = RawSubscription(self._observer.node.context)
        self._graph = Graph()
        self._nodes_with_endpoints: set[str] = set()
        self._topics = FollowedTopics(self._raw_subscription)
        self._parameters = ParameterWatch(self._observer, send)
        self._calls = ServiceCalls(self._observer, send)
        self._manual_publisher = ManualPublisher(self._observer.node.context)
        self._publishing = Publishing(self._manual_publisher, self._topics.expect, send)
        self._visible = True
        self._tasks: set[asyncio.Task[None]] = set()
        self._fingerprint: object = None
        self._read_at = 0.0
        send(Ready(domain_id))

    async def run(self) -> None:
        """Send updates until cancelled."""
        check_at = 0.0
        while True:
            now = time.monotonic()
            if now >= check_at:
                self._read_graph(now)
                check_at = now + GRAPH_CHECK_INTERVAL_S
                self._parameters.retry_unresponsive()
            if self._visible:
                for update in self._topics.updates():
                    self._send(update)
            if (fault := self._observer.fault) is not None:
                self._observer.fault = None
                self._send(WatcherError(f"Watching failed: {type(fault).__name__}: {fault}"))
            await asyncio.sleep(UPDATE_INTERVAL_S)  # the update interval; not a wait for any condition

    def handle(self, request: WatcherRequest) -> None:
        """Handle a request from the app. Responses are sent as updates."""
        match request:
            case Follow(topic):
                self._topics.follow(topic, self._graph)
            case Unfollow(topic):
                self._topics.unfollow(topic)
            case Clear(topic):
                self._topics.clear(topic)
            case Plot(topic, field):
                self._topics.plot(topic, field)
            case SetVisible(visible):
                self._visible = visible
            case Refresh():
                self._read_at = 0.0
                self._read_graph(time.monotonic())
                self._parameters.refresh_all()
            case SetParameter():
                self._in_background(self._set_parameter(request))
            case Publish():
                self._in_background(self._publishing.begin(request))
            case StopPublishing(topic):
                self._in_background(self._publishing.end(topic))
            case Describe(type_name):
                self._send(describe(type_name))
            case Call():
                self._calls.begin(request)
            case Cancel(id):
                self._calls.cancel(id)

    def close(self) -> None:
        """Leave the domain."""
        self._manual_publisher.close()
        self._raw_subscription.close()
        self._observer.close()

    def _in_background(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _set_parameter(self, request: SetParameter) -> None:
        self._send(await self._parameters.set(request))
        self._parameters.refresh(request.node)

    def _read_graph(self, now: float) -> None:
        fingerprint = graph_fingerprint(self._observer.node)
        if fingerprint == self._fingerprint and now < self._read_at + GRAPH_READ_INTERVAL_S:
            return
        self._fingerprint, self._read_at = fingerprint, now
        graph = without_ghosts(read_graph(self._observer.node, standard_topics=True), self._nodes_with_endpoints)
        if graph != self._graph:
            self._graph = graph
            self._send(graph)
        self._topics.update_graph(graph)
        self._parameters.update_graph(graph)
