"""Settings of a launch file that do not hold for a node: pushed namespaces, remappings and configurations."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.launch_case import endpoints_of, launch_file, remappings_of, value_of
from tutor.ros_model import Graph, TopicEndpoint
from tutor.source.file import SourceFile, called_name
from tutor.source.launch_order import Action, Reach, actions_of, reach

_NAMES = (Symptom.WRONG_NAMES,)
_PUSHES = ("PushRosNamespace", "PushROSNamespace")
_example = in_run(
    Symptom.WRONG_NAMES,
    moves="namespace",
    argument="namespace",
    wanted="hall",
    graph=Graph(("/bell",), (TopicEndpoint("/ring", "t", "/bell"),)),
)


def _missed(case: Case, *why: Reach) -> Iterator[tuple[Action, ast.Call, Reach]]:
    """What sets the argument's value for nodes to come, and a node that it does not reach for one of these reasons.

    Only where a node was seen without the value.
    """
    file = launch_file(case).file
    settings, nodes = _settings(case, file), actions_of(file, "Node", "LifecycleNode")
    for setting in settings:
        for node in nodes:
            reached = {reach(other, node) for other in settings}
            if Reach.REACHED not in reached and (missing := reach(setting, node)) in why:
                yield setting, node.call, missing


def _settings(case: Case, file: SourceFile) -> list[Action]:
    names: tuple[str, ...] = ()
    if case.about("moves") == "namespace":
        under = f"/{case.about('wanted')}/"
        names = _PUSHES if any(not endpoint.node.startswith(under) for endpoint in endpoints_of(case)) else ()
    elif case.about("moves") == "topic" and not any(target == value_of(case) for _, target in remappings_of(case)):
        names = ("SetRemap",)
    return actions_of(file, *names)


@mistake(
    "setting-lost-with-its-group",
    explains=_NAMES,
    says="{line} sets {what} in a group, and the end of the group undoes it{when}: {code}",
    do="{do}",
    example=_example,
)
def lost_with_group(case: Case) -> Iterator[Found]:
    """Something is set in a group, and needed outside.

    A GroupAction is scoped: at its end, launch configurations, pushed namespaces and remappings are again what they
    were before it. What a handler of an event starts, or a TimerAction, comes when the group has long ended, even if
    the handler stands in it.

    Bad:

        GroupAction([PushRosNamespace(LaunchConfiguration('target'))])
        Node(package='house', executable='bell')

    Good:

        GroupAction([
            PushRosNamespace(LaunchConfiguration('target')),
            Node(package='house', executable='bell'),
        ])

    See it: `ros2 node list`.

    Lesson: i2.2, on namespaces.
    """
    file = launch_file(case)
    for setting, node, why in _missed(case, Reach.GROUP_ENDED, Reach.HANDLER):
        late = why is Reach.HANDLER
        when = f", before the Node in line {node.lineno} is started by its handler" if late else ""
        do = "Begin a group inside the handler with it, and put that node into this group."
        if not late:
            do = "Put the nodes for which it is meant into the same group, below it."
        what = "a namespace" if called_name(setting.call) in _PUSHES else "a remapping"
        yield found(case.file, setting.call, what=what, when=when, do=do)
    for group in file.calls("GroupAction"):
        for call in file.calls("SetLaunchConfiguration"):
            name = call.argument(0, "name")
            inside = call.code in group.code and "scoped" not in group.named
            reads = [read for read in file.calls("LaunchConfiguration") if read.argument(0, "variable_name") == name]
            if inside and any(read.code not in group.code for read in reads):
                words = {"what": name.strip("'\""), "when": "", "do": "Set it outside the group."}
                yield Found(dict(words), case.file.name, call.line, case.file.line(call.line))


@mistake(
    "set-after-the-node",
    explains=_NAMES,
    says="{line} comes after the Node in line {node}, but affects only what comes after it: {code}",
    do="Put it before the nodes that it is meant for, in the list that launch works through.",
    example=_example,
)
def too_late(case: Case) -> Iterator[Found]:
    """A namespace is pushed, or a remapping set, after the node.

    A launch description is executed from top to bottom. PushRosNamespace and SetRemap change what comes after them; a
    node that has been started keeps its names.

    Bad:

        Node(package='house', executable='bell')
        PushRosNamespace(LaunchConfiguration('floor'))

    Good:

        PushRosNamespace(LaunchConfiguration('floor'))
        Node(package='house', executable='bell')

    See it: `ros2 node list`.

    Lesson: i2.2, on namespaces.
    """
    for setting, node, _ in _missed(case, Reach.TOO_LATE):
        yield found(case.file, setting.call, node=node.lineno)


@mistake(
    "setting-under-a-condition",
    explains=_NAMES,
    says="{line} is left out, since its condition, {condition}, is not met: {code}",
    do="Give it a condition that is also met in this launch, or none.",
    example=_example,
)
def condition_not_met(case: Case) -> Iterator[Found]:
    """A namespace or remapping has a condition that is not met.

    Every action can have a condition. If it is not met, launch leaves out the action without a word.

    Bad:

        PushRosNamespace(LaunchConfiguration('floor'), condition=IfCondition('false'))
        Node(package='house', executable='bell')

    Good:

        PushRosNamespace(LaunchConfiguration('floor'))
        Node(package='house', executable='bell')

    See it: `ros2 node list`, and `ros2 launch FILE --show-args` for the defaults that the condition reads.
    """
    if any(True for _ in _missed(case, Reach.GROUP_ENDED, Reach.HANDLER, Reach.TOO_LATE)):
        return
    file = launch_file(case).file
    for setting in _settings(case, file) if actions_of(file, "Node", "LifecycleNode") else ():
        for keyword in setting.call.keywords:
            if keyword.arg == "condition":
                yield found(case.file, setting.call, condition=_short(ast.unparse(keyword.value)))


def _short(code: str) -> str:
    return code if len(code) <= 60 else f"{code[:57]}..."
