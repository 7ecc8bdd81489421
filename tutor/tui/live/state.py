"""What the app knows of the domain, from the updates of the watching process. Pure."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass, field, replace

from tutor.content import LiveView
from tutor.live.protocol import Ready, Update
from tutor.live.updates import CallOutcome, NodeParameters, PublishStatus, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Connection, Graph, Parameter, Topic, connections

KEEP_POINTS_S = 120.0
"""How much of a plotted field is kept, in seconds."""

KEEP_LINES = 500
"""This many lines of what has come on a topic are kept."""

_MOST_POINTS = 20_000
_MOST_OUTCOMES = 200


@dataclass(frozen=True, slots=True)
class PausedView:
    """A topic as it stood when it was paused, at a wall-clock time in seconds."""

    update: TopicUpdate | None
    lines: tuple[str, ...]
    came: int
    points: tuple[tuple[float, float], ...]
    at: float


@dataclass(slots=True)
class TopicView:
    """A followed topic as it is shown. While `paused`, what is shown stays, and everything is counted all the same.

    `lines` are the last of the `came` lines that its messages were written in. `by_hand`: the learner has chosen to
    follow it.
    """

    topic: str
    by_hand: bool = False
    update: TopicUpdate | None = None
    lines: deque[str] = field(default_factory=lambda: deque(maxlen=KEEP_LINES))
    came: int = 0
    fields: tuple[str, ...] = ()
    path: str = ""
    points: deque[tuple[float, float]] = field(default_factory=lambda: deque(maxlen=_MOST_POINTS))
    updated_at: float = 0.0
    paused: bool = False
    held: PausedView | None = None

    def receive(self, update: TopicUpdate, now: float) -> None:
        """Take an update of it; `now` is a wall-clock time in seconds."""
        self.update, self.updated_at = update, now
        if update.text is not None:
            written = [*update.text.splitlines(), "---"]
            self.lines.extend(written)
            self.came += len(written)
        self.fields = update.fields or self.fields
        if update.field and not self.path:
            self.path = update.field
        if update.field == self.path:  # points of the one before may still be on their way
            self.points.extend(update.points)
        while self.points and self.points[0][0] < self.points[-1][0] - KEEP_POINTS_S:
            self.points.popleft()

    def pause(self, now: float) -> None:
        """Hold what is shown, or let it go on."""
        self.paused = not self.paused
        held = PausedView(self.update, tuple(self.lines), self.came, tuple(self.points), now)
        self.held = held if self.paused else None

    def clear(self) -> None:
        """Forget what has come."""
        self.lines.clear()
        self.came = 0
        self.points.clear()
        self.update = None if self.update is None else replace(self.update, count=0, timing=None, silent_s=None, lost=0)
        self.paused, self.held = False, None

    def plot(self, path: str) -> None:
        """Show another field."""
        self.path = path
        self.points.clear()


@dataclass(slots=True)
class LiveState:
    """Everything that is known. `waiting` are the calls without an answer yet, by id: the service, and since when."""

    domain: int = 0
    ready: bool = False
    asked: LiveView = field(default_factory=LiveView)
    """What the lesson that is shown is about."""
    graph: Graph | None = None
    topics: dict[str, TopicView] = field(default_factory=dict)
    parameters: dict[str, NodeParameters] = field(default_factory=dict)
    sets: deque[SetOutcome] = field(default_factory=lambda: deque(maxlen=_MOST_OUTCOMES))
    calls: deque[CallOutcome] = field(default_factory=lambda: deque(maxlen=_MOST_OUTCOMES))
    waiting: dict[int, tuple[str, float]] = field(default_factory=dict)
    forms: dict[str, RequestForm] = field(default_factory=dict)
    published: dict[str, PublishStatus] = field(default_factory=dict)
    """What the learner publishes from here, by topic; of what was published once, the last."""

    def receive(self, update: Update) -> None:
        """Take an update."""
        match update:
            case Ready(domain):
                self.domain, self.ready = domain, True
            case Graph():
                self.graph = update
                self.parameters = {node: held for node, held in self.parameters.items() if node in update.nodes}
            case TopicUpdate():
                if view := self.topics.get(update.topic):
                    view.receive(update, time.time())
            case NodeParameters():
                self.parameters[update.node] = update
            case SetOutcome():
                self.sets.appendleft(update)
            case CallOutcome():
                self.waiting.pop(update.id, None)
                self.calls.appendleft(update)
            case RequestForm():
                self.forms[update.type] = update
            case PublishStatus():
                self._publishing(update)

    def _publishing(self, update: PublishStatus) -> None:
        self.published = {topic: held for topic, held in self.published.items() if not held.over}
        if not update.over or update.problem or update.sent:
            self.published[update.topic] = update

    def lost(self) -> None:
        """The watching process is gone: nothing is known any more, but what was done is kept."""
        self.ready, self.graph = False, None
        self.parameters.clear()
        self.waiting.clear()
        self.published.clear()

    @property
    def nodes(self) -> tuple[str, ...]:
        """Every node's name."""
        return self.graph.nodes if self.graph else ()

    def listed_topics(self) -> list[Topic]:
        """Those in the graph, and those that are followed though nobody has them now; the standard ones last."""
        there = {topic.name: topic for topic in self.graph.topics} if self.graph else {}
        for name in self.topics:
            there.setdefault(name, Topic(name))
        return sorted(there.values(), key=lambda topic: (topic.is_standard, topic.name))

    def is_asked(self, topic: str) -> bool:
        """Whether the exercise is about this topic."""
        return any(known.name == topic for known in self.asked.topics)

    def is_published(self, topic: str) -> bool:
        """Whether somebody publishes on it now."""
        found = self.graph.topic(topic) if self.graph else None
        return found is not None and bool(found.publishers)

    def mismatches(self) -> list[Connection]:
        """Every pair of endpoints between which no message can go."""
        topics = self.graph.topics if self.graph else ()
        return [pair for topic in topics for pair in connections(topic) if pair.problems]

    def listed_parameters(self, everything: bool = True) -> list[Parameter]:
        """Of every node that answered, in the order of their names; without `everything` only those of its own."""
        return [
            each
            for node in sorted(self.parameters)
            for each in sorted(self.parameters[node].parameters, key=lambda parameter: parameter.name)
            if everything or not is_standard_parameter(each.name)
        ]


def is_standard_parameter(name: str) -> bool:
    """Whether nodes have such a parameter without declaring it."""
    return name in ("use_sim_time", "start_type_description_service") or name.startswith("qos_overrides.")
