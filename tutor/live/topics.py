"""Followed topics: messages are counted in the subscription's thread and reported at a bounded rate."""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass, field

from tutor.errors import UnknownType
from tutor.live.statistics import TopicStatistics
from tutor.live.updates import TopicUpdate
from tutor.ros.batches import Received
from tutor.ros.interfaces import interface_class
from tutor.ros.messages import truncate
from tutor.ros.raw_subscription import RawSubscription, deserialize
from tutor.ros.yaml_format import number_at, numeric_fields, to_yaml
from tutor.ros_model import Graph, QoS, Topic, TopicEndpoint, echo_qos

POINTS_PER_UPDATE = 10
"""Most messages sampled for a plot between two updates, whatever the topic's rate."""

BIG_BYTES = 100_000
"""If messages are larger than this, only the newest is sampled."""

MAX_BYTES = 10_000_000
"""Messages larger than this are only counted."""

MAX_TEXT = 100_000
"""A message's YAML text is cut at this many characters."""

SILENT_INTERVAL_S = 1.0
"""Interval of updates for a silent topic."""

_FORMATTING_SHARE = 0.2
"""At most this share of the time is spent on formatting the messages of a topic."""


@dataclass(slots=True)
class _Followed:
    topic: str
    type: str = ""
    qos: QoS = field(default_factory=QoS)
    subscribed: object = None
    problem: str = ""
    many_publishers: bool = False
    path: str = ""
    fields: tuple[str, ...] = ()
    statistics: TopicStatistics = field(default_factory=TopicStatistics)
    newest: bytes | None = None
    reported: bytes | None = None
    samples: deque[tuple[float, bytes]] = field(default_factory=lambda: deque(maxlen=POINTS_PER_UPDATE))
    last_at: float | None = None
    reported_at: float = 0.0
    text_after: float = 0.0
    stale: bool = True
    lock: threading.Lock = field(default_factory=threading.Lock)

    def add(self, batch: list[Received]) -> None:
        """Add messages. Called in the subscription's thread."""
        stamps = [info["source_timestamp"] * 1e-9 for _, info in batch]
        numbers = [info["publication_sequence_number"] for _, info in batch]
        newest = batch[-1][0]
        with self.lock:
            self.statistics.add(stamps, numbers)
            self.newest = newest
            if len(newest) > BIG_BYTES:
                self.samples.clear()
            self.samples.append((stamps[-1], newest))
            self.last_at = time.monotonic()
            self.stale = True


class FollowedTopics:
    """Manages the followed topics and their statistics."""

    def __init__(self, raw_subscription: RawSubscription) -> None:
        self._raw_subscription = raw_subscription
        self._followed: dict[str, _Followed] = {}

    def follow(self, topic: str, graph: Graph) -> None:
        """Follow a topic, now or as soon as it appears."""
        if topic not in self._followed:
            self._followed[topic] = _Followed(topic)
            self._resubscribe(self._followed[topic], graph.topic(topic))

    def expect(self, topic: str, type_name: str) -> bool:
        """Subscribe before we publish a message of this type, if the topic is followed. Return whether it is."""
        followed = self._followed.get(topic)
        if followed is not None and followed.subscribed is None:
            self._resubscribe(followed, Topic(topic, (TopicEndpoint(topic, type_name, ""),)))
        return followed is not None

    def unfollow(self, topic: str) -> None:
        """Stop following a topic."""
        if self._followed.pop(topic, None) is not None:
            self._raw_subscription.unsubscribe(topic)

    def clear(self, topic: str) -> None:
        """Reset a topic's count and statistics."""
        if followed := self._followed.get(topic):
            with followed.lock:
                followed.statistics = TopicStatistics()
                followed.samples.clear()
                followed.newest = followed.reported = followed.last_at = None
                followed.stale = True

    def plot(self, topic: str, path: str) -> None:
        """Choose the field to sample for a plot."""
        if followed := self._followed.get(topic):
            followed.path = path
            followed.stale = True

    def update_graph(self, graph: Graph) -> None:
        """Subscribe to topics that have appeared, and resubscribe where type or QoS has changed."""
        for followed in self._followed.values():
            self._resubscribe(followed, graph.topic(followed.topic))

    def updates(self) -> list[TopicUpdate]:
        """Return the updates that are due."""
        now = time.monotonic()
        return [self._report(followed, now) for followed in self._followed.values() if _is_due(followed, now)]

    def _resubscribe(self, followed: _Followed, topic: Topic | None) -> None:
        if topic is None or not topic.publishers:
            return  # keep the subscription: publishers may come back
        types = tuple(dict.fromkeys(publisher.type for publisher in topic.publishers))
        followed.many_publishers = followed.many_publishers or len(topic.publishers) > 1
        old_problem, followed.problem = followed.problem, _problem(types)
        followed.stale = followed.stale or followed.problem != old_problem
        if followed.problem:
            return
        qos = echo_qos(publisher.qos for publisher in topic.publishers)
        wanted = (types[0], qos)
        if wanted == followed.subscribed:
            return
        followed.subscribed = wanted
        followed.type = types[0]
        followed.qos = qos
        followed.stale = True
        self._raw_subscription.subscribe(followed.topic, types[0], qos, followed.add)

    def _report(self, followed: _Followed, now: float) -> TopicUpdate:
        with followed.lock:
            count, timing = followed.statistics.count, followed.statistics.timing()
            lost = None if followed.many_publishers else followed.statistics.missing
            samples = list(followed.samples)
            followed.samples.clear()
            newest, last_at = followed.newest, followed.last_at
            followed.stale = False
        followed.reported_at = now
        text, fields = self._format_newest(followed, newest, now)
        readable = [sample for sample in samples if followed.path and len(sample[1]) <= MAX_BYTES]
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

    def _format_newest(
        self, followed: _Followed, newest: bytes | None, now: float
    ) -> tuple[str | None, tuple[str, ...]]:
        if newest is None or newest is followed.reported or now < followed.text_after:
            return None, ()
        if len(newest) > MAX_BYTES:
            followed.reported = newest
            return f"(a message of {len(newest) / 1e6:.0f} MB: too big to show here)", ()
        began = time.perf_counter()
        message = deserialize(followed.type, newest)
        text = truncate(to_yaml(message), MAX_TEXT)
        fields = numeric_fields(message)
        if not followed.path and fields:
            followed.path = next((path for path in fields if "stamp" not in path.split(".")), fields[0])
        changed, followed.fields, followed.reported = fields != followed.fields, fields, newest
        followed.text_after = now + (time.perf_counter() - began) * (1 / _FORMATTING_SHARE - 1)
        return text, fields if changed else ()


def _is_due(followed: _Followed, now: float) -> bool:
    if followed.stale or (followed.newest is not followed.reported and now >= followed.text_after):
        return True
    return followed.last_at is not None and now - followed.reported_at >= SILENT_INTERVAL_S


def _problem(types: tuple[str, ...]) -> str:
    """Return why a topic with publishers of these types cannot be shown; empty if it can."""
    if len(types) > 1:
        return f"Publishers of different types: {' and '.join(types)}. A topic has only one type."
    try:
        interface_class(types[0])
    except UnknownType:
        return f"This ROS does not have the type {types[0]}: build or source the package that has it."
    return ""
