"""Everything that is watched on one domain, and what is done there on request."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from typing import Any

from tutor.live.calls import ServiceCalls, describe
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
"""Topics are told about at most this often, in seconds, however fast they are."""

LOOK_EVERY_S = 0.5
LOOK_CLOSELY_EVERY_S = 2.0
"""The graph is looked at this often, in seconds; closely, where a quick look finds nothing new."""


class Watcher:
    """One participant that watches. `say` is given all updates, on the event loop's thread."""

    def __init__(self, domain_id: int, say: Callable[[Update], object]) -> None:
        self._say = say
        self._observer = Observer(domain_id)
        self._raw_subscription = RawSubscription(self._observer.node.context)
        self._graph = Graph()
        self._topics = FollowedTopics(self._raw_subscription)
        self._parameters = ParameterWatch(self._observer, say)
        self._calls = ServiceCalls(self._observer, say)
        self._manual_publisher = ManualPublisher(self._observer.node.context)
        self._publishing = Publishing(self._manual_publisher, self._topics.expect, say)
        self._seen = True
        self._tasks: set[asyncio.Task[None]] = set()
        self._known: object = None
        self._looked_closely = 0.0
        say(Ready(domain_id))

    async def run(self) -> None:
        """Tell what is new, until cancelled."""
        look_at = 0.0
        while True:
            now = time.monotonic()
            if now >= look_at:
                self._look(now)
                look_at = now + LOOK_EVERY_S
                self._parameters.retry_silent()
            if self._seen:
                for update in self._topics.updates():
                    self._say(update)
            if (fault := self._observer.fault) is not None:
                self._observer.fault = None
                self._say(WatcherError(f"Watching broke: {type(fault).__name__}: {fault}"))
            await asyncio.sleep(UPDATE_EVERY_S)  # the pace of the updates, not a wait for anything

    def do(self, request: WatcherRequest) -> None:
        """Do what the app asks for; answers come as updates."""
        match request:
            case Follow(topic):
                self._topics.follow(topic, self._graph)
            case Unfollow(topic):
                self._topics.unfollow(topic)
            case Clear(topic):
                self._topics.clear(topic)
            case Plot(topic, field):
                self._topics.plot(topic, field)
            case SetVisible(seen):
                self._seen = seen
            case Refresh():
                self._looked_closely = 0.0
                self._look(time.monotonic())
                self._parameters.ask_all()
            case SetParameter():
                self._beside(self._set(request))
            case Publish():
                self._beside(self._publishing.begin(request))
            case StopPublishing(topic):
                self._beside(self._publishing.end(topic))
            case Describe(type_name):
                self._say(describe(type_name))
            case Call():
                self._calls.begin(request)
            case Cancel(id):
                self._calls.cancel(id)

    def close(self) -> None:
        """Leave the domain."""
        self._manual_publisher.close()
        self._raw_subscription.close()
        self._observer.close()

    def _beside(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _set(self, request: SetParameter) -> None:
        self._say(await self._parameters.set(request))
        self._parameters.ask(request.node)

    def _look(self, now: float) -> None:
        known = graph_fingerprint(self._observer.node)
        if known == self._known and now < self._looked_closely + LOOK_CLOSELY_EVERY_S:
            return
        self._known, self._looked_closely = known, now
        graph = read_graph(self._observer.node, standard_topics=True)
        if graph != self._graph:
            self._graph = graph
            self._say(graph)
        self._topics.look(graph)
        self._parameters.look(graph)
