"""Names that only some nodes of a launch have, and arguments without any effect."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.launch_case import endpoints_of, last_part, reaches_no_node, remappings_of, value_of
from tutor.ros_model import Graph, TopicEndpoint

_NAMES = (Symptom.WRONG_NAMES,)


@mistake(
    "absolute-topic",
    explains=_NAMES,
    evidence=Evidence.SYMPTOM,
    says="the nodes are under /{namespace}, but {node} uses {topic}: {because}",
    do="Leave out the slash in front of the name, so that it is taken within the namespace.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="namespace",
        argument="namespace",
        wanted="hall",
        graph=Graph(("/hall/bell",), (TopicEndpoint("/ring", "t", "/hall/bell"),)),
    ),
)
def absolute(case: Case) -> Iterator[Found]:
    """A topic's name begins with a slash.

    A name with a leading slash is absolute, and no namespace changes it. Without the slash, it is in the namespace of
    its node.

    Bad:

        remappings=[('ring', '/doorbell')]

    Good:

        remappings=[('ring', 'doorbell')]

    See it: `ros2 topic list`.
    """
    if case.about("moves") != "namespace":
        return
    namespace = case.about("wanted")
    under = f"/{namespace}/"
    slash = next((target for _, target in remappings_of(case) if target.startswith("/")), None)
    because = f"the remapping to {slash} begins with a slash" if slash else "its name begins with a slash"
    endpoints = endpoints_of(case)
    if all(endpoint.node.startswith(under) for endpoint in endpoints):
        for endpoint in endpoints:
            if not endpoint.topic.startswith(under):
                words = {"namespace": namespace, "node": endpoint.node, "topic": endpoint.topic, "because": because}
                yield Found(words)


@mistake(
    "namespace-of-its-own",
    explains=(*_NAMES, Symptom.NOT_CONNECTED),
    evidence=Evidence.RUN,
    says="{node} is in the namespace {namespace}, and so its topics are there, apart from those of the other node",
    do="Give both nodes the same namespace.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="topic",
        argument="topic",
        wanted="/dong",
        graph=Graph(("/attic/bell",), (TopicEndpoint("/attic/dong", "t", "/attic/bell"),)),
    ),
)
def own_namespace(case: Case) -> Iterator[Found]:
    """A node is in a namespace of its own.

    A relative topic name is taken within the namespace of its node, so the same name means another topic in another
    namespace.

    Bad:

        Node(package='house', executable='bell', namespace='attic', remappings=[('ring', 'doorbell')])
        Node(package='house', executable='door', remappings=[('ring', 'doorbell')])

    Good:

        Node(package='house', executable='bell', remappings=[('ring', 'doorbell')])
        Node(package='house', executable='door', remappings=[('ring', 'doorbell')])

    See it: `ros2 node list`, `ros2 topic list`.
    """
    wanted = str(case.about("wanted", ""))
    endpoints = endpoints_of(case)
    for endpoint in endpoints:
        namespace = endpoint.node.rpartition("/")[0]
        relative = endpoint.topic.removeprefix(f"{namespace}/")
        if not namespace or relative == endpoint.topic:
            continue
        if case.about("moves") == "topic":
            apart = relative == last_part(wanted) and endpoint.topic != wanted
        else:
            others = {other.topic for other in endpoints if not other.node.startswith(f"{namespace}/")}
            apart = case.symptom is Symptom.NOT_CONNECTED and f"/{relative}" in others
        if apart:
            yield Found({"node": endpoint.node, "namespace": namespace})


@mistake(
    "only-one-node-is-renamed",
    explains=_NAMES,
    evidence=Evidence.SYMPTOM,
    says="{what}",
    do="Give every node the same remappings, and the same namespace.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="topic",
        argument="topic",
        wanted="/dong",
        graph=Graph(
            ("/bell", "/door"), (TopicEndpoint("/dong", "t", "/bell"),), (TopicEndpoint("/ring", "t", "/door"),)
        ),
    ),
)
def one_node(case: Case) -> Iterator[Found]:
    """Only one of two nodes is renamed.

    Each node has its own remappings and its own namespace: what one node is given, the other does not have.

    Bad:

        Node(package='house', executable='bell', remappings=[('ring', 'doorbell')])
        Node(package='house', executable='door')

    Good:

        Node(package='house', executable='bell', remappings=[('ring', 'doorbell')])
        Node(package='house', executable='door', remappings=[('ring', 'doorbell')])

    See it: `ros2 topic info -v TOPIC`.
    """
    endpoints, wanted = endpoints_of(case), str(case.about("wanted", ""))
    if case.about("moves") == "topic":
        inside = sorted({endpoint.node for endpoint in endpoints if endpoint.topic == wanted})
        outside = sorted(
            {f"{endpoint.node} uses {endpoint.topic}" for endpoint in endpoints if endpoint.topic != wanted}
        )
        where = wanted
    else:
        where = f"/{wanted}"
        inside = sorted({endpoint.node for endpoint in endpoints if endpoint.node.startswith(f"{where}/")})
        outside = sorted({endpoint.node for endpoint in endpoints if not endpoint.node.startswith(f"{where}/")})
    alone = len({endpoint.node for endpoint in endpoints}) > 1 and len(inside) == 1
    if alone and outside:
        are = "uses" if case.about("moves") == "topic" else "is under"
        yield Found({"what": f"{', '.join(inside)} {are} {where}, and {', '.join(outside)}{_not(case)}"})


def _not(case: Case) -> str:
    return "" if case.about("moves") == "topic" else " is not"


@mistake(
    "default-topic-still-used",
    explains=_NAMES,
    evidence=Evidence.SYMPTOM,
    says="still on {topics}: {users}",
    do="Give every node that uses the topic the same remappings.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="topic",
        argument="topic",
        wanted="/dong",
        still_used=("/ring",),
        users=("/old_bell",),
        graph=Graph(("/bell", "/old_bell"), (TopicEndpoint("/dong", "t", "/bell"),)),
    ),
)
def still_used(case: Case) -> Iterator[Found]:
    """Something stays on the default topic.

    A topic is renamed for those nodes that have the remapping. Another node, or another copy of the same one, keeps
    using the name in its code.

    Bad:

        Node(package='house', executable='bell', remappings=[('ring', LaunchConfiguration('sound'))])
        Node(package='house', executable='bell', name='old_bell')

    Good:

        Node(package='house', executable='bell', remappings=[('ring', LaunchConfiguration('sound'))])

    See it: `ros2 topic info -v TOPIC`.
    """
    if case.about("still_used") and case.about("wanted") in {endpoint.topic for endpoint in endpoints_of(case)}:
        yield Found({"users": ", ".join(case.about("users")), "topics": ", ".join(case.about("still_used"))})


@mistake(
    "argument-without-effect",
    explains=_NAMES,
    evidence=Evidence.SYMPTOM,
    says="{argument}:={value} is given, but no topic and no namespace takes its value",
    do="Use the value of the argument in every node: a topic in its remappings, a namespace as its namespace.",
    example=in_run(Symptom.WRONG_NAMES, moves="topic", argument="topic", wanted="/dong"),
)
def no_effect(case: Case) -> Iterator[Found]:
    """A launch argument is declared, but used nowhere.

    A declaration only says that there is such an argument. LaunchConfiguration stands for its value, which has an
    effect only where it is given to a node.

    Bad:

        DeclareLaunchArgument('sound', default_value='ding')
        Node(package='house', executable='bell')

    Good:

        DeclareLaunchArgument('sound', default_value='ding')
        Node(package='house', executable='bell', remappings=[('ring', LaunchConfiguration('sound'))])

    See it: `ros2 topic list`.
    """
    value = value_of(case)
    used = any(value in name.split("/") for endpoint in endpoints_of(case) for name in (endpoint.node, endpoint.topic))
    if case.about("argument") is not None and not used and reaches_no_node(case):
        yield Found({"argument": case.about("argument"), "value": value})
