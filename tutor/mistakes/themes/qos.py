"""Quality of service: endpoints that are not connected."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Graph, QoS, QoSMismatch, TopicEndpoint, incompatible_policies


def _mismatches(case: Case) -> Iterable[tuple[str, QoSMismatch]]:
    ours = case.about("ours")
    topic = case.about("topic", ours.topic if ours else None)
    graph = case.trace.graph
    publishers = [ours] if ours else [publisher for publisher in graph.publishers if publisher.topic == topic]
    for publisher in publishers:
        for subscription in (endpoint for endpoint in graph.subscriptions if endpoint.topic == publisher.topic):
            for mismatch in incompatible_policies(publisher.qos, subscription.qos):
                yield publisher.topic, mismatch


@mistake(
    "incompatible-qos",
    name="incompatible QoS",
    explains=(Symptom.NOTHING_RECEIVED, Symptom.NOT_CONNECTED),
    evidence=Evidence.RUN,
    says="on {topic}, {mismatch}",
    do="Let the subscription ask for no more {policy} than the publisher offers, or let the publisher offer more.",
    example=in_run(
        Symptom.NOTHING_RECEIVED,
        graph=Graph(
            ("/node",),
            (TopicEndpoint("/horn", "std_msgs/msg/Bool", "/driver", QoS(reliability="best_effort")),),
            (TopicEndpoint("/horn", "std_msgs/msg/Bool", "/node", QoS(reliability="reliable")),),
        ),
        topic="/horn",
    ),
)
def incompatible_qos(case: Case) -> Iterator[Found]:
    """Publisher and subscription have incompatible QoS.

    A publisher offers a quality of service, and a subscription requests one. If it requests more than is offered
    (reliability from a best-effort publisher, old messages from a volatile one), the two are not connected, and nothing
    arrives.

    Bad:

        self.create_subscription(Bool, 'horn', self.on_horn, QoSProfile(depth=5))

    Good:

        self.create_subscription(Bool, 'horn', self.on_horn, qos_profile_sensor_data)

    See it: `ros2 topic info -v TOPIC` shows the QoS of both ends; rclpy warns of "incompatible QoS" in the log.
    """
    for topic, mismatch in _mismatches(case):
        yield Found({"topic": topic, "mismatch": mismatch, "policy": mismatch.policy})


@mistake(
    "not-a-ros-topic",
    name="not a ROS topic",
    explains=(Symptom.NO_MESSAGES, Symptom.NOTHING_RECEIVED),
    says="{line} leaves out the prefix by which ROS nodes find topics in DDS, so no other ROS node sees this one",
    do="Leave avoid_ros_namespace_conventions off.",
)
def bare_topic_names(case: Case) -> Iterator[Found]:
    """A QoS profile hides a topic from ROS.

    ROS gives its topics a prefix in DDS. avoid_ros_namespace_conventions leaves it out, so that programs without ROS
    can join; nodes that do not do the same never see such a topic.

    Bad:

        quiet = QoSProfile(depth=5, avoid_ros_namespace_conventions=True)

    Good:

        quiet = QoSProfile(depth=5)

    See it: `ros2 topic info -v TOPIC`: the publisher is not listed.
    """
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.keyword(arg=str(name), value=ast.Constant(value=True) as value):
                    pass
                case ast.Assign(targets=[ast.Attribute(attr=name)], value=ast.Constant(value=True) as value):
                    pass
                case _:
                    continue
            if name == "avoid_ros_namespace_conventions":
                yield found(file, value)
