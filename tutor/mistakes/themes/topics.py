"""Topics: names and types of publishers and subscriptions, and what never publishes."""

from __future__ import annotations

import ast
import difflib
from collections.abc import Iterator, Sequence

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Graph, TopicEndpoint
from tutor.source import NodeFile

_MISSING = (Symptom.NO_MESSAGES, Symptom.NOTHING_RECEIVED)


def _endpoints(case: Case) -> Sequence[TopicEndpoint]:
    """The learner's endpoints of the kind that is missing."""
    graph = case.trace.graph
    return graph.publishers if case.symptom is Symptom.NO_MESSAGES else graph.subscriptions


def _creator(case: Case) -> str:
    return "create_publisher" if case.symptom is Symptom.NO_MESSAGES else "create_subscription"


def _place(case: Case, creator: str, text: str) -> Found:
    """The call that makes an endpoint: the one with this text, else the only one; without a place if unknown."""
    creators = (creator, creator.replace("_", "_lifecycle_", 1))
    calls = [(file, call) for file in case.files for call in file.calls(*creators)]
    named = [(file, call) for file, call in calls if text in file.line(call.lineno)]
    for file, call in named or (calls if len(calls) == 1 else []):
        return found(file, call)
    return Found()


def _endpoint_graph(*, topic: str = "/horn", type: str = "std_msgs/msg/Bool") -> Graph:
    return Graph(("/node",), publishers=(TopicEndpoint(topic, type, "/node"),))


@mistake(
    "wrong-type",
    explains=_MISSING,
    evidence=Evidence.RUN,
    says="{topic} has the type {given}, not {wanted}",
    do="Give {creator} the type that is asked for, and import it from its package.",
    example=in_run(Symptom.NO_MESSAGES, graph=_endpoint_graph(), topic="/horn", type="std_msgs/msg/String"),
)
def wrong_type(case: Case) -> Iterator[Found]:
    """The topic is right, but its type is not.

    A publisher and a subscription meet only if their types are the same, package and name. Types with the same fields,
    or the same name in two packages, are still different types.

    Bad:

        self.horn = self.create_publisher(Bool, 'horn', 10)

    Good:

        self.horn = self.create_publisher(String, 'horn', 10)

    See it: `ros2 topic list -t`; two types on one topic are shown side by side.
    """
    topic, wanted = case.about("topic"), case.about("type")
    here = [endpoint for endpoint in _endpoints(case) if endpoint.topic == topic]
    if here and wanted and all(endpoint.type != wanted for endpoint in here):
        at = _place(case, _creator(case), topic.rpartition("/")[2])
        words = {"topic": topic, "given": here[0].type, "wanted": wanted, "creator": _creator(case)}
        yield Found(words, at.file, at.line, at.code)


@mistake(
    "wrong-topic",
    explains=_MISSING,
    evidence=Evidence.RUN,
    says="there is {given}, not {wanted}: {difference}",
    do="Use exactly the name {wanted} where the {endpoint} is made.",
    example=in_run(Symptom.NO_MESSAGES, graph=_endpoint_graph(topic="/horns"), topic="/horn", type="std_msgs/msg/Bool"),
)
def wrong_topic(case: Case) -> Iterator[Found]:
    """The type is right, but the name is not.

    Names are compared letter by letter. Without a leading slash, a name is relative: the node's namespace comes before
    it; with a leading ~, so does the node's name. Two names that differ are two topics, and ROS does not complain.

    Bad:

        self.horn = self.create_publisher(Bool, 'horns', 10)

    Good:

        self.horn = self.create_publisher(Bool, 'horn', 10)

    See it: `ros2 topic list`, and `ros2 node info NODE` for the names that a node uses.
    """
    topic, wanted_type = case.about("topic"), case.about("type")
    endpoints = _endpoints(case)
    if not topic or any(endpoint.topic == topic for endpoint in endpoints):
        return
    near = [endpoint for endpoint in endpoints if difflib.get_close_matches(endpoint.topic, [topic], cutoff=0.6)]
    names = {endpoint.topic for endpoint in endpoints if endpoint.type == wanted_type}
    names = names or {endpoint.topic for endpoint in near}
    if names:
        given = max(sorted(names), key=lambda name: difflib.SequenceMatcher(None, name, topic).ratio())
        at = _place(case, _creator(case), given.rpartition("/")[2])
        endpoint = "publisher" if case.symptom is Symptom.NO_MESSAGES else "subscription"
        words = {"given": given, "wanted": topic, "difference": name_difference(given, topic), "endpoint": endpoint}
        yield Found(words, at.file, at.line, at.code)


def name_difference(given: str, wanted: str) -> str:
    """How the name of a topic or service differs from the one that is wanted, in words."""
    if given.endswith(wanted):
        return "a namespace or the node's name is in front, as for a name that begins with ~ or without a slash"
    if given.replace("/", "").replace("_", "") == wanted.replace("/", "").replace("_", ""):
        return "the slash between its parts is missing, or there is one too many"
    if wanted.endswith(given):
        return "the first part of the name is missing"
    if given.casefold() == wanted.casefold():
        return "upper and lower case make different names"
    return "it is spelled differently"


@mistake(
    "no-publisher",
    explains=[Symptom.NO_MESSAGES],
    evidence=Evidence.SYMPTOM,
    says="{nodes} is up, but has no publisher on {topic}",
    do="Create a publisher for {topic} where the node is set up.",
    example=in_run(Symptom.NO_MESSAGES, topic="/horn"),
)
def no_publisher(case: Case) -> Iterator[Found]:
    """A node has no publisher on the topic.

    A topic exists once some node publishes or subscribes. create_publisher has to be called, with the type and the
    name, while the node is set up.

    Bad:

        def __init__(self):
            super().__init__('driver')

    Good:

        def __init__(self):
            super().__init__('driver')
            self.horn = self.create_publisher(Bool, 'horn', 10)

    See it: `ros2 node info NODE` lists what it publishes.
    """
    topic = case.about("topic")
    is_published = any(publisher.topic == topic for publisher in case.trace.graph.publishers)
    if topic and case.trace.graph.nodes and not is_published and not case.about("lifecycle"):
        yield Found({"topic": topic})


@mistake(
    "subscription-destroyed",
    explains=[Symptom.NOTHING_RECEIVED],
    says="{nodes} has given up its subscription on {topic}, at {line}: {code}",
    do="Keep the subscription for as long as the node lives.",
    example=in_run(Symptom.NOTHING_RECEIVED, topic="/horn"),
)
def subscription_destroyed(case: Case) -> Iterator[Found]:
    """A node gives up its subscription.

    A subscription lives until it is destroyed, whoever publishes. It needs no renewal when a publisher goes away: the
    next one is found automatically.

    Bad:

        if self.count_publishers('horn') == 0:
            self.destroy_subscription(self.horn)

    Good:

        if self.count_publishers('horn') == 0:
            self.get_logger().info('nobody sounds the horn any more')

    See it: `ros2 topic info TOPIC` counts the subscriptions.
    """
    topic = case.about("topic")
    if topic and not any(subscription.topic == topic for subscription in case.trace.graph.subscriptions):
        for file in case.files:
            yield from (found(file, call, topic=topic) for call in file.calls("destroy_subscription"))


@mistake(
    "no-subscription",
    explains=[Symptom.NOTHING_RECEIVED],
    evidence=Evidence.SYMPTOM,
    says="{nodes} is up, but has no subscription on {topic}",
    do="Create a subscription to {topic} where the node is set up.",
    example=in_run(Symptom.NOTHING_RECEIVED, topic="/horn"),
)
def no_subscription(case: Case) -> Iterator[Found]:
    """A node has no subscription to the topic.

    Messages reach only nodes that have called create_subscription with the same type and name.

    Bad:

        def __init__(self):
            super().__init__('listener')

    Good:

        def __init__(self):
            super().__init__('listener')
            self.create_subscription(Bool, 'horn', self.on_horn, 10)

    See it: `ros2 node info NODE` lists what it subscribes to.
    """
    topic = case.about("topic")
    is_subscribed = any(subscription.topic == topic for subscription in case.trace.graph.subscriptions)
    if topic and case.trace.graph.nodes and not is_subscribed:
        yield Found({"topic": topic})


@mistake(
    "nothing-calls-publish",
    explains=[Symptom.NO_MESSAGES],
    says="{line} makes a publisher, and {what}: {code}",
    do="Let a timer call the method that publishes, again and again.",
)
def unused_publisher(case: Case) -> Iterator[Found]:
    """A publisher is made, but never used.

    create_publisher only announces that messages may come. Each message takes a call of publish(), and something has to
    make that call: the callback of a timer, a subscription or a service.

    Bad:

        def __init__(self):
            self.horn = self.create_publisher(Bool, 'horn', 10)

    Good:

        def __init__(self):
            self.horn = self.create_publisher(Bool, 'horn', 10)
            self.create_timer(2.0, self.sound)

        def sound(self):
            self.horn.publish(Bool(data=True))

    See it: `ros2 topic info TOPIC` counts one publisher; `ros2 topic echo TOPIC` shows nothing.
    """
    for file in case.files if not case.about("some") else ():
        for call in file.calls("create_publisher", "create_lifecycle_publisher"):
            if not case.program.calls("publish"):
                yield found(file, call, what="nothing calls its publish()")
            elif not case.program.calls("create_timer", "create_subscription") and not _publishes_again(file):
                yield found(file, call, what="no timer calls what publishes")


def _publishes_again(file: NodeFile) -> bool:
    """Whether a call of publish() stands in a loop, or in a function that something uses."""
    for call in file.calls("publish"):
        around = file.function_around(call)
        used = {node.id if isinstance(node, ast.Name) else getattr(node, "attr", "") for node in file.nodes}
        if any(isinstance(ancestor, ast.While | ast.For | ast.AsyncFor) for ancestor in file.ancestors(call)):
            return True
        if around is not None and around.name != "main" and around.name in used:
            return True
    return False
