"""The topics that are followed: counted in the subscription's thread, told about at a bounded rate."""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass, field

from tutor.errors import UnknownType
from tutor.live.statistics import TopicStatistics
from tutor.live.updates import TopicUpdate
from tutor.ros.messages import cut, interface_class
from tutor.ros.raw_subscription import Batch, RawSubscription, deserialize
from tutor.ros.yaml_format import number_at, numeric_fields, to_yaml
from tutor.ros_model import Graph, QoS, Topic, TopicEndpoint, echo_qos

POINTS_PER_UPDATE = 10
"""Values sampled for a plot between two updates: a hundred a second, whatever the topic's rate."""

BIG = 100_000
"""Of messages of more bytes than this, only the newest one is sampled."""

BIGGEST = 10_000_000
"""Messages of more bytes than this are counted only."""

MOST_TEXT = 100_000
"""Of a message's text, this many characters are told."""

SILENT_EVERY_S = 1.0
"""How often a silent topic is told about, in seconds."""

_SHARE_OF_TEXT = 0.2
"""At most this share of the time is spent on writing a topic's messages as text."""


@dataclass(slots=True)
class _Followed:
    topic: str
    type: str = ""
    qos: QoS = field(default_factory=QoS)
    opened: object = None
    problem: str = ""
    several: bool = False
    path: str = ""
    fields: tuple[str, ...] = ()
    statistics: TopicStatistics = field(default_factory=TopicStatistics)
    newest: bytes | None = None
    told: bytes | None = None
    samples: deque[tuple[float, bytes]] = field(default_factory=lambda: deque(maxlen=POINTS_PER_UPDATE))
    last_at: float | None = None
    told_at: float = 0.0
    text_after: float = 0.0
    stale: bool = True
    lock: threading.Lock = field(default_factory=threading.Lock)

    def take(self, batch: Batch) -> None:
        """In the subscription's thread."""
        with self.lock:
            self.statistics.add(batch.stamps, batch.numbers)
            self.newest = batch.newest
            if len(batch.newest) > BIG:
                self.samples.clear()
            self.samples.append((batch.stamps[-1], batch.newest))
            self.last_at = time.monotonic()
            self.stale = True


class FollowedTopics:
    """Which topics are followed, and what has come on them."""

    def __init__(self, raw_subscription: RawSubscription) -> None:
        self._raw_subscription = raw_subscription
        self._all: dict[str, _Followed] = {}

    def follow(self, topic: str, graph: Graph) -> None:
        """Follow a topic, now or as soon as it is there."""
        if topic not in self._all:
            self._all[topic] = _Followed(topic)
            self._settle(self._all[topic], graph.topic(topic))

    def expect(self, topic: str, type_name: str) -> bool:
        """A message of this type is about to be published: subscribe now. Returns whether the topic is followed."""
        followed = self._all.get(topic)
        if followed is not None and followed.opened is None:
            self._settle(followed, Topic(topic, (TopicEndpoint(topic, type_name, ""),)))
        return followed is not None

    def unfollow(self, topic: str) -> None:
        """Follow it no longer."""
        if self._all.pop(topic, None) is not None:
            self._raw_subscription.unsubscribe(topic)

    def clear(self, topic: str) -> None:
        """Count from nothing."""
        if followed := self._all.get(topic):
            with followed.lock:
                followed.statistics = TopicStatistics()
                followed.samples.clear()
                followed.newest = followed.told = followed.last_at = None
                followed.stale = True

    def plot(self, topic: str, path: str) -> None:
        """Sample this field."""
        if followed := self._all.get(topic):
            followed.path = path
            followed.stale = True

    def look(self, graph: Graph) -> None:
        """The graph has changed: subscribe to what has appeared, and again where publishers offer another QoS."""
        for followed in self._all.values():
            self._settle(followed, graph.topic(followed.topic))

    def updates(self) -> list[TopicUpdate]:
        """What is new since the last call."""
        now = time.monotonic()
        return [self._tell(followed, now) for followed in self._all.values() if _is_due(followed, now)]

    def _settle(self, followed: _Followed, topic: Topic | None) -> None:
        if topic is None or not topic.publishers:
            return  # one that has been there may come back: the subscription stays
        types = tuple(dict.fromkeys(publisher.type for publisher in topic.publishers))
        followed.several = followed.several or len(topic.publishers) > 1
        before, followed.problem = followed.problem, _problem(types)
        followed.stale = followed.stale or followed.problem != before
        if followed.problem:
            return
        qos = echo_qos(publisher.qos for publisher in topic.publishers)
        wanted = (types[0], qos)
        if wanted == followed.opened:
            return
        followed.opened = wanted
        followed.type = types[0]
        followed.qos = qos
        followed.stale = True
        self._raw_subscription.subscribe(followed.topic, types[0], qos, followed.take)

    def _tell(self, followed: _Followed, now: float) -> TopicUpdate:
        with followed.lock:
            count, timing = followed.statistics.count, followed.statistics.timing()
            lost = None if followed.several else followed.statistics.missing
            samples = list(followed.samples)
            followed.samples.clear()
            newest, last_at = followed.newest, followed.last_at
            followed.stale = False
        followed.told_at = now
        text, fields = self._text(followed, newest, now)
        readable = [each for each in samples if followed.path and len(each[1]) <= BIGGEST]
        points = [
            (stamp, value)
            for stamp, raw in readable
            if (value := number_at(deserialize(followed.type, raw), followed.path)) is not None
        ]
        return TopicUpdate(
            topic=followed.topic,
            type=followed.type,
            qos=followed.qos,
            count=count,
            lost=lost,
            timing=timing,
            silent_s=None if last_at is None else max(0.0, now - last_at),
            text=text,
            fields=fields,
            field=followed.path,
            points=tuple(points),
            problem=followed.problem,
        )

    def _text(self, followed: _Followed, newest: bytes | None, now: float) -> tuple[str | None, tuple[str, ...]]:
        if newest is None or newest is followed.told or now < followed.text_after:
            return None, ()
        if len(newest) > BIGGEST:
            followed.told = newest
            return f"(a message of {len(newest) / 1e6:.0f} MB: too big to be shown here)", ()
        began = time.perf_counter()
        message = deserialize(followed.type, newest)
        text = cut(to_yaml(message), MOST_TEXT)
        fields = numeric_fields(message)
        if not followed.path and fields:
            followed.path = next((path for path in fields if "stamp" not in path.split(".")), fields[0])
        changed, followed.fields, followed.told = fields != followed.fields, fields, newest
        followed.text_after = now + (time.perf_counter() - began) * (1 / _SHARE_OF_TEXT - 1)
        return text, fields if changed else ()


def _is_due(followed: _Followed, now: float) -> bool:
    if followed.stale or (followed.newest is not followed.told and now >= followed.text_after):
        return True
    return followed.last_at is not None and now - followed.told_at >= SILENT_EVERY_S


def _problem(types: tuple[str, ...]) -> str:
    """Why a topic with these publishers' types cannot be shown."""
    if len(types) > 1:
        return f"Publishers of different types: {' and '.join(types)}. One topic has one type."
    try:
        interface_class(types[0])
    except UnknownType:
        return f"This ROS does not have the type {types[0]}: build or source the package that has it."
    return ""
