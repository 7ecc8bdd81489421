"""Quality of service: endpoints that are connected, and still not everything arrives."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Graph, QoS, TopicEndpoint, incompatible_policies
from tutor.source import SourceFile, argument, called_name, values_of

SENSOR_DEPTH = 5
"""The depth of qos_profile_sensor_data."""


def _connected(case: Case) -> Sequence[TopicEndpoint]:
    """The learner's subscriptions that are connected to our publisher."""
    ours: TopicEndpoint | None = case.about("ours")
    if ours is None:
        return ()
    return [
        subscription
        for subscription in case.trace.graph.subscriptions
        if (subscription.topic, subscription.type) == (ours.topic, ours.type)
        and not any(incompatible_policies(ours.qos, subscription.qos))
    ]


def _subscribed(*qos: QoS) -> Graph:
    return Graph(("/node",), subscriptions=tuple(TopicEndpoint("/horn", "std_msgs/msg/Bool", "/node", q) for q in qos))


def _offering(qos: QoS) -> TopicEndpoint:
    return TopicEndpoint("/horn", "std_msgs/msg/Bool", "/driver", qos)


@mistake(
    "late-subscriber",
    explains=[Symptom.NOTHING_RECEIVED],
    evidence=Evidence.RUN,
    says="what is on {topic} was published before {nodes} was there. The publisher keeps it for those who come later "
    "(durability transient local), but the subscription asks for volatile: only what is new",
    do="Let the subscription ask for the durability that the publisher offers.",
    example=in_run(
        Symptom.NOTHING_RECEIVED,
        graph=_subscribed(QoS()),
        ours=_offering(QoS(durability="transient_local")),
        kept=True,
    ),
)
def late_subscriber(case: Case) -> Iterator[Found]:
    """A subscription that comes late does not ask for what was kept for it.

    With durability "transient local", a publisher keeps its last messages, as many as its depth says, and hands them to
    subscriptions that come later: a map, a robot's description, a state that hardly ever changes. Only a subscription
    that asks for transient local as well gets them. One that asks for volatile, as by default, is connected without
    any warning, and gets what is published from then on.

    Bad:

        self.create_subscription(Bool, 'gate_open', self.on_gate, 1)

    Good:

        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(Bool, 'gate_open', self.on_gate, latched)

    See it: `ros2 topic info -v TOPIC` shows the durability of both ends.

    Lesson: b1.1, on durability.
    """
    connected = _connected(case)
    ours = case.about("ours")
    if not case.about("kept") or not connected or ours.qos.durability != "transient_local":
        return
    if all(subscription.qos.durability == "volatile" for subscription in connected):
        yield Found({"topic": ours.topic})


@mistake(
    "best-effort-where-each-counts",
    name="best effort where each message counts",
    explains=[Symptom.MESSAGES_LOST, Symptom.NOTHING_RECEIVED],
    evidence=Evidence.RUN,
    says="the publisher on {topic} is reliable, but the subscription asks for best effort: what gets lost on its way "
    "is never sent again",
    do="Let the subscription ask for the reliability that the publisher offers.",
    example=in_run(
        Symptom.MESSAGES_LOST, graph=_subscribed(QoS(reliability="best_effort")), ours=_offering(QoS()), sent=9, shown=9
    ),
)
def best_effort(case: Case) -> Iterator[Found]:
    """A subscription asks for best effort where each message counts.

    A best-effort subscription is connected to every publisher, so it seems the safe choice. But then nobody notices
    that a message was lost, and nobody sends it again, even if the publisher is reliable. That suits a sensor, whose
    next reading comes soon. A command, an order or a map is sent once.

    Bad:

        self.create_subscription(Bool, 'ring', self.on_ring, qos_profile_sensor_data)

    Good:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)

    See it: `ros2 topic info -v TOPIC` shows the reliability of both ends; a bad wireless network shows the rest.

    Lesson: b1.1, on reliability.
    """
    connected, ours = _connected(case), case.about("ours")
    if not connected or ours.qos.reliability != "reliable":
        return
    counts = case.symptom is Symptom.MESSAGES_LOST or case.about("kept")
    if counts and all(subscription.qos.reliability == "best_effort" for subscription in connected):
        yield Found({"topic": ours.topic})


@mistake(
    "queue-shorter-than-a-burst",
    explains=[Symptom.MESSAGES_LOST],
    evidence=Evidence.RUN,
    says="{sent} messages came on {topic} at once, and {shown} were handled: those that waited for the callback were "
    "pushed out by newer ones, since the queue of the subscription holds {depth}{where}",
    do="Let the queue hold as many messages as a burst has, or all.",
    example=in_run(Symptom.MESSAGES_LOST, ours=_offering(QoS()), sent=60, shown=12, newest=True),
)
def short_queue(case: Case) -> Iterator[Found]:
    """A burst is longer than the queue of a subscription.

    Messages wait in a queue of the subscription until the executor calls the callback. Its length is the QoS depth.
    When it is full, each message that comes pushes out the oldest one, even if both ends are reliable: that was
    delivered, and nobody sends it again. With the history "keep all", nothing is pushed out.

    Bad:

        self.create_subscription(Bool, 'ring', self.on_ring, 5)

    Good:

        self.create_subscription(Bool, 'ring', self.on_ring, 100)

    See it: count in the callback; no tool shows the depth (`ros2 topic info -v` says UNKNOWN).

    Lesson: b1.1, on depth.
    """
    sent, shown, ours = case.about("sent", 0), case.about("shown", 0), case.about("ours")
    if ours is None or not case.about("newest") or not 1 < shown < sent:
        return
    name = ours.topic.rpartition("/")[2]
    for file in case.files:
        for call in file.calls("create_subscription"):
            depth = _depth(file, argument(call, "qos_profile"))
            if name in ast.unparse(call) and depth is not None:
                if depth < sent:
                    where = f" ({case.place(file.name, call.lineno)})"
                    yield found(
                        file, call, topic=ours.topic, sent=sent, shown=shown, depth=f"only {depth}", where=where
                    )
                return
    yield Found({"topic": ours.topic, "sent": sent, "shown": shown, "depth": "fewer", "where": ""})


def _depth(file: SourceFile, qos: ast.expr | None) -> int | None:
    """The depth of a QoS as it is written, directly or in a variable; None if it is not clear, or keeps all."""
    if isinstance(qos, ast.Name | ast.Attribute):
        if ast.unparse(qos).endswith("qos_profile_sensor_data"):
            return SENSOR_DEPTH
        values = values_of(ast.unparse(qos), file.tree)
        qos = values[0] if len(values) == 1 else None
    if isinstance(qos, ast.Call) and called_name(qos) == "QoSProfile" and "KEEP_ALL" not in ast.unparse(qos):
        qos = next((keyword.value for keyword in qos.keywords if keyword.arg == "depth"), None)
    return qos.value if isinstance(qos, ast.Constant) and type(qos.value) is int else None


@mistake(
    "subscribed-twice",
    explains=[Symptom.SHOWN_AGAIN],
    evidence=Evidence.RUN,
    says="{nodes} has {number} subscriptions on {topic}, and each of them gets every message",
    do="Keep one subscription on {topic}, with a QoS that suits the publisher.",
    example=in_run(
        Symptom.SHOWN_AGAIN, graph=_subscribed(QoS(), QoS(reliability="best_effort")), ours=_offering(QoS())
    ),
)
def subscribed_twice(case: Case) -> Iterator[Found]:
    """A node has several subscriptions on one topic.

    Two subscriptions with different QoS, to be on the safe side, both get whatever the publisher sends to either of
    them. Each calls its callback, so everything is done twice.

    Bad:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)
        self.create_subscription(Bool, 'ring', self.on_ring, qos_profile_sensor_data)

    Good:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)

    See it: `ros2 topic info TOPIC` counts the subscriptions.
    """
    connected = _connected(case)
    if len(connected) > 1:
        yield Found({"number": len(connected), "topic": connected[0].topic})
