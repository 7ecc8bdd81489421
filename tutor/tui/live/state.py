"""What the app knows about the domain, from the updates of the watcher process. Pure."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass, field, replace

from tutor.content import LiveView
from tutor.live.protocol import Ready, Update
from tutor.live.updates import CallOutcome, NodeParameters, PublishStatus, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Connection, Graph, Parameter, Topic, connections

_POINTS_KEPT_S = 120.0
"""How many seconds of a plotted field are kept."""

_LINES_KEPT = 500
"""How many lines of a topic's messages are kept."""

_MAX_POINTS = 20_000
_MAX_OUTCOMES = 200


@dataclass(frozen=True, slots=True)
class PausedView:
    """A snapshot of a topic, taken when it was paused `at` a wall-clock time in seconds."""

    update: TopicUpdate | None
    lines: tuple[str, ...]
    line_count: int
    points: tuple[tuple[float, float], ...]
    at: float


@dataclass(slots=True)
class TopicView:
    """A followed topic as it is shown. While `paused`, the display keeps `snapshot`, but messages are still counted.

    `lines` are the latest of the `line_count` lines that its messages were printed in so far.
    """

    topic: str
    update: TopicUpdate | None = None
    lines: deque[str] = field(default_factory=lambda: deque(maxlen=_LINES_KEPT))
    line_count: int = 0
    fields: tuple[str, ...] = ()
    path: str = ""
    points: deque[tuple[float, float]] = field(default_factory=lambda: deque(maxlen=_MAX_POINTS))
    updated_at: float = 0.0
    paused: bool = False
    snapshot: PausedView | None = None

    def receive(self, update: TopicUpdate, now: float) -> None:
        """Apply an update; `now` is a wall-clock time in seconds."""
        self.update, self.updated_at = update, now
        if update.text is not None:
            new_lines = [*update.text.splitlines(), "---"]
            self.lines.extend(new_lines)
            self.line_count += len(new_lines)
        self.fields = update.fields or self.fields
        if update.field and not self.path:
            self.path = update.field
        if update.field == self.path:  # points of the previous field may still arrive
            self.points.extend(update.points)
        while self.points and self.points[0][0] < self.points[-1][0] - _POINTS_KEPT_S:
            self.points.popleft()

    def pause(self, now: float) -> None:
        """Pause the display, or resume it."""
        self.paused = not self.paused
        snapshot = PausedView(self.update, tuple(self.lines), self.line_count, tuple(self.points), now)
        self.snapshot = snapshot if self.paused else None

    def clear(self) -> None:
        """Forget all messages so far, and resume."""
        self.lines.clear()
        self.line_count = 0
        self.points.clear()
        self.update = None if self.update is None else replace(self.update, count=0, timing=None, silent_s=None, lost=0)
        self.paused, self.snapshot = False, None

    def plot(self, path: str) -> None:
        """Plot another field."""
        self.path = path
        self.points.clear()


@dataclass(slots=True)
class LiveState:
    """All that is known about the domain. `waiting`: pending service calls by id, as service name and start time."""

    domain: int = 0
    ready: bool = False
    lesson_view: LiveView = field(default_factory=LiveView)
    """The topics and services that the shown lesson is about."""
    graph: Graph | None = None
    first_seen: dict[str, LiveView] = field(default_factory=dict)
    """For each node in the graph, the view of the lesson that was shown when it appeared."""
    topics: dict[str, TopicView] = field(default_factory=dict)
    parameters: dict[str, NodeParameters] = field(default_factory=dict)
    sets: deque[SetOutcome] = field(default_factory=lambda: deque(maxlen=_MAX_OUTCOMES))
    calls: deque[CallOutcome] = field(default_factory=lambda: deque(maxlen=_MAX_OUTCOMES))
    waiting: dict[int, tuple[str, float]] = field(default_factory=dict)
    forms: dict[str, RequestForm] = field(default_factory=dict)
    published: dict[str, PublishStatus] = field(default_factory=dict)
    """What the learner publishes from this page, by topic; a message published once stays until the next status."""

    def receive(self, update: Update) -> None:
        """Apply an update."""
        match update:
            case Ready(domain):
                self.domain, self.ready = domain, True
            case Graph():
                self.graph = update
                self.first_seen = {node: self.first_seen.get(node, self.lesson_view) for node in update.nodes}
                self.parameters = {node: held for node, held in self.parameters.items() if node in update.nodes}
            case TopicUpdate():
                if view := self.topics.get(update.topic):
                    view.receive(update, time.time())
            case NodeParameters():
                if update.node in self.nodes:  # it may have gone while it was asked
                    self.parameters[update.node] = update
            case SetOutcome():
                self.sets.appendleft(update)
            case CallOutcome():
                self.waiting.pop(update.id, None)
                self.calls.appendleft(update)
            case RequestForm():
                self.forms[update.type] = update
            case PublishStatus():
                self._receive_publish_status(update)

    def set_lesson(self, view: LiveView) -> None:
        """Note the lesson that is shown; what was set and called in another one is no longer listed."""
        if view is not self.lesson_view:
            self.lesson_view = view
            self.sets.clear()
            self.calls.clear()

    def _receive_publish_status(self, update: PublishStatus) -> None:
        self.published = {topic: status for topic, status in self.published.items() if not status.over}
        if not update.over or update.problem or update.sent:
            self.published[update.topic] = update

    def reset_domain(self) -> None:
        """Forget the domain once the watcher process is gone; keep followed topics, and past sets and calls."""
        self.ready, self.graph = False, None
        self.first_seen.clear()
        self.parameters.clear()
        self.waiting.clear()
        self.published.clear()

    @property
    def nodes(self) -> tuple[str, ...]:
        """The names of all nodes."""
        return self.graph.nodes if self.graph else ()

    def listed_topics(self) -> list[Topic]:
        """Return the topics in the graph, and followed ones that no node has now; the standard topics last."""
        topics = {topic.name: topic for topic in self.graph.topics} if self.graph else {}
        for name in self.topics:
            topics.setdefault(name, Topic(name))
        return sorted(topics.values(), key=lambda topic: (topic.is_standard, topic.name))

    def is_lesson_topic(self, topic: str) -> bool:
        """Return whether the shown lesson is about this topic."""
        return any(known.name == topic for known in self.lesson_view.topics)

    def is_published(self, topic: str) -> bool:
        """Return whether the topic has a publisher now."""
        found = self.graph.topic(topic) if self.graph else None
        return found is not None and bool(found.publishers)

    def type_of(self, topic: str) -> str:
        """Return the topic's type, by the graph or else by the lesson; empty if neither knows it."""
        found = self.graph.topic(topic) if self.graph else None
        lesson_types = (known.type for known in self.lesson_view.topics if known.name == topic)
        return found.types[0] if found is not None else next(lesson_types, "")

    def mismatches(self) -> list[Connection]:
        """Return every pair of endpoints that cannot exchange messages."""
        topics = self.graph.topics if self.graph else ()
        return [pair for topic in topics for pair in connections(topic) if pair.problems]

    def listed_parameters(self, everything: bool = True) -> list[Parameter]:
        """Return the parameters by node and name.

        Those that every node has, and those of nodes that were started with another lesson, only if `everything`.
        """
        return [
            parameter
            for node in sorted(self.parameters)
            if everything or self.is_of_lesson(node)
            for parameter in sorted(self.parameters[node].parameters, key=lambda parameter: parameter.name)
            if everything or not is_standard_parameter(parameter.name)
        ]

    def is_of_lesson(self, node: str) -> bool:
        """Return whether the node appeared while the lesson shown now was shown."""
        return self.first_seen.get(node) is self.lesson_view


def is_standard_parameter(name: str) -> bool:
    """Return whether nodes have this parameter without declaring it."""
    return name in ("use_sim_time", "start_type_description_service") or name.startswith("qos_overrides.")
