"""Nodes that a launch file describes and does not start, and nodes that do not meet."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.launch_case import at_call, launch_file, nodes_of
from tutor.ros_model import Graph, TopicEndpoint

_LATER = {
    "OnProcessExit": "only when another process has ended",
    "OnProcessStart": "only when another process has started",
    "TimerAction": "only after some time",
    "OnExecutionComplete": "only when another action is complete",
    "OnShutdown": "only when the launch ends",
}


@mistake(
    "node-not-started",
    explains=[Symptom.NOT_LAUNCHED],
    says="{what}",
    do="Put the node itself into the list of the LaunchDescription, without a condition.",
)
def not_started(case: Case) -> Iterator[Found]:
    """A node is described, but not started.

    launch starts the nodes that are in the list of the LaunchDescription, if their condition is met. What is in an
    event handler starts when that event comes, or never.

    Bad:

        bell = Node(package='house', executable='bell')
        return LaunchDescription([])

    Good:

        bell = Node(package='house', executable='bell')
        return LaunchDescription([bell])

    See it: `ros2 launch FILE --print`.
    """
    file = launch_file(case)
    for node in nodes_of(file):
        if "condition" in node.named:
            what = f"the Node in line {node.line} has condition={node.named['condition']}, which is not met"
            yield at_call(case, node, what=what)
        elif node.kept and not file.uses(node.kept):
            yield at_call(
                case, node, what=f"{node.kept} (line {node.line}) is made, but is not in the launch description"
            )
    for call in file.calls(*_LATER):
        yield at_call(case, call, what=f"what {call.name} in line {call.line} holds starts {_LATER[call.name]}")


@mistake(
    "one-side-missing",
    explains=[Symptom.NOT_LAUNCHED],
    evidence=Evidence.SYMPTOM,
    says="{what}",
    do="Start two programs, one that publishes and one that subscribes, with a Node for each.",
    example=in_run(Symptom.NOT_LAUNCHED, graph=Graph(("/bell",), (TopicEndpoint("/ring", "t", "/bell"),))),
)
def one_side(case: Case) -> Iterator[Found]:
    """There is a publisher but no subscriber, or the other way round.

    Two nodes talk to each other only if one publishes and the other subscribes.

    Bad:

        LaunchDescription([Node(package='house', executable='bell')])

    Good:

        LaunchDescription([
            Node(package='house', executable='bell'),
            Node(package='house', executable='door'),
        ])

    See it: `ros2 topic info -v TOPIC`.
    """
    graph = case.trace.graph
    senders = sorted(
        {publisher.node for publisher in graph.publishers if not publisher.topic.startswith(("/rosout", "/parameter"))}
    )
    receivers = sorted(
        {subscription.node for subscription in graph.subscriptions if not subscription.topic.startswith("/parameter")}
    )
    if not graph.nodes:
        return
    if senders and not receivers:
        yield Found({"what": f"{', '.join(senders)} publishes, but nothing subscribes"})
    elif receivers and not senders:
        yield Found({"what": f"{', '.join(receivers)} subscribes, but nothing publishes"})
    elif senders:
        yield Found({"what": f"{', '.join(senders)} does both on its own"})
    else:
        yield Found({"what": f"{', '.join(graph.nodes)}: neither publishes nor subscribes"})


@mistake(
    "different-topics",
    name="wrong topic",
    explains=[Symptom.NOT_CONNECTED],
    evidence=Evidence.SYMPTOM,
    says="{what}",
    do="Remap both to the same name.",
    example=in_run(
        Symptom.NOT_CONNECTED,
        graph=Graph(
            ("/bell", "/door"), (TopicEndpoint("/ring", "t", "/bell"),), (TopicEndpoint("/horn", "t", "/door"),)
        ),
    ),
)
def different_topics(case: Case) -> Iterator[Found]:
    """Publisher and subscriber use different topics.

    Each node's code has a name for its topic. Two programs that were not written for each other need remappings to
    meet.

    Bad:

        Node(package='house', executable='bell')
        Node(package='house', executable='door', remappings=[('horn', 'rings')])

    Good:

        Node(package='house', executable='bell')
        Node(package='house', executable='door', remappings=[('horn', 'ring')])

    See it: `ros2 topic list`.
    """
    graph = case.trace.graph
    ours = ("/rosout", "/parameter_events")
    publishers = [publisher for publisher in graph.publishers if publisher.topic not in ours]
    subscriptions = [subscription for subscription in graph.subscriptions if subscription.topic not in ours]
    senders = sorted({f"{publisher.node} publishes on {publisher.topic}" for publisher in publishers})
    heard = sorted({f"{subscription.node} subscribes to {subscription.topic}" for subscription in subscriptions})
    sent = {publisher.topic for publisher in publishers}
    if senders and heard and not any(subscription.topic in sent for subscription in subscriptions):
        yield Found({"what": f"{', '.join(senders)}; {', '.join(heard)}"})


@mistake(
    "process-left-behind",
    explains=[Symptom.DOES_NOT_END],
    evidence=Evidence.RUN,
    says="the launch has ended, but this still runs: {command}",
    do="Let the launch description start it instead of Python code: then launch ends it, too.",
    example=in_run(Symptom.DOES_NOT_END, left_behind="sleep 1000"),
)
def left_behind(case: Case) -> Iterator[Found]:
    """A process outlives the launch that started it.

    launch sends SIGINT to what its actions have started. It knows nothing of a program that the launch file's Python
    code starts on its own, which goes on.

    Bad:

        subprocess.Popen(['ring-the-bell'])

    Good:

        ExecuteProcess(cmd=['ring-the-bell'])

    See it: `ps` after Ctrl+C.
    """
    if case.about("left_behind"):
        yield Found({"command": case.about("left_behind")})
