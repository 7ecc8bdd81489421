"""Watches one domain, and acts on it on request."""

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

UPDATE_EVERY_S = 0.2
"""Topic updates are sent at most this often, in seconds, however fast the topics are."""

CHECK_GRAPH_EVERY_S = 0.5
READ_GRAPH_EVERY_S = 2.0
"""How often the graph is checked for changes, and read in full where the check finds none, in seconds."""


class Watcher:
    """A participant that watches. `send` gets every update, on the event loop's thread."""

    def __init__(self, domain_id: int, send: Callable[[Update], object]) -> None:
        self._send = send
        self._observer = Observer(domain_id, guarded=False)
        self._raw_subscription = RawSubscription(self._observer.node.context)
        self._graph = Graph()
        self._connected: set[str] = set()  # nodes that have had endpoints
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
                check_at = now + CHECK_GRAPH_EVERY_S
                self._parameters.retry_silent()
            if self._visible:
                for update in self._topics.updates():
                    self._send(update)
            if (fault := self._observer.fault) is not None:
                self._observer.fault = None
                self._send(WatcherError(f"Watching broke: {type(fault).__name__}: {fault}"))
            await asyncio.sleep(UPDATE_EVERY_S)  # the pace of the updates, not a wait for anything

    def handle(self, request: WatcherRequest) -> None:
        """Handle a request of the app; answers are sent as updates."""
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
                self._parameters.ask_all()
            case SetParameter():
                self._in_background(self._set(request))
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

    async def _set(self, request: SetParameter) -> None:
        self._send(await self._parameters.set(request))
        self._parameters.ask(request.node)

    def _read_graph(self, now: float) -> None:
        fingerprint = graph_fingerprint(self._observer.node)
        if fingerprint == self._fingerprint and now < self._read_at + READ_GRAPH_EVERY_S:
            return
        self._fingerprint, self._read_at = fingerprint, now
        graph = without_ghosts(read_graph(self._observer.node, standard_topics=True), self._connected)
        if graph != self._graph:
            self._graph = graph
            self._send(graph)
        self._topics.update_graph(graph)
        self._parameters.update_graph(graph)
