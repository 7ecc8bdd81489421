"""Launch arguments: why the value of one does not become the name of a node or topic."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from difflib import get_close_matches

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.launch_case import at_call, endpoints_of, launch_file, nodes_of, reaches_no_node
from tutor.ros_model import Graph, TopicEndpoint
from tutor.source.launch_file import LaunchFile

_NAMES = (Symptom.WRONG_NAMES,)


def _uses(argument: str) -> re.Pattern[str]:
    return re.compile(rf"LaunchConfiguration\('{argument}'")


def _names_of(file: LaunchFile, argument: str) -> set[str]:
    """The variables that keep the argument's value."""
    return {
        call.kept for call in file.calls("LaunchConfiguration") if call.argument(0, "variable_name") == f"'{argument}'"
    }


def _is_used(file: LaunchFile, argument: str, code: str) -> bool:
    names = _names_of(file, argument) - {""}
    return bool(_uses(argument).search(code)) or any(re.search(rf"(?<!['\w]){name}(?!['\w])", code) for name in names)


@mistake(
    "namespace-applied-twice",
    explains=_NAMES,
    evidence=Evidence.RUN,
    says="{name} is in the namespace {namespace} twice",
    do="Use only one of the two: a namespace for each node, or one that is pushed for all.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="namespace",
        argument="namespace",
        wanted="hall",
        graph=Graph(("/hall/hall/bell",), (TopicEndpoint("/hall/hall/ring", "t", "/hall/hall/bell"),)),
    ),
)
def twice(case: Case) -> Iterator[Found]:
    """A namespace is applied twice.

    PushRosNamespace puts all nodes of its group into a namespace, and namespace= puts a single node into one. Together,
    they nest.

    Bad:

        PushRosNamespace('hall')
        Node(package='house', executable='bell', namespace='hall')

    Good:

        PushRosNamespace('hall')
        Node(package='house', executable='bell')

    See it: `ros2 node list`.
    """
    doubled = f"/{case.about('wanted')}/{case.about('wanted')}/"
    for endpoint in endpoints_of(case) if case.about("moves") == "namespace" else ():
        for name in (endpoint.node, endpoint.topic):
            if name.startswith(doubled):
                yield Found({"name": name, "namespace": case.about("wanted")})


@mistake(
    "no-such-launch-argument",
    explains=_NAMES,
    evidence=Evidence.RUN,
    says="{argument}:= changes nothing, since what the launch file declares is {declared}",
    do="Use exactly this name where the argument is declared and where its value is read.",
    example=in_run(Symptom.WRONG_NAMES, argument="sound", wanted="ding"),
)
def argument_name(case: Case) -> Iterator[Found]:
    """A launch argument has another name, or is not declared.

    name:=value on the command line sets the launch configuration of that name. If no argument has that name, nothing
    reads it, and launch does not complain.

    Bad:

        DeclareLaunchArgument('sounds', default_value='ding')

    Good:

        DeclareLaunchArgument('sound', default_value='ding')

    See it: `ros2 launch FILE --show-args`.
    """
    argument, declared = case.about("argument"), case.trace.launch_arguments
    if argument is not None and argument not in declared and reaches_no_node(case):
        calls = {call.argument(0, "name").strip("'"): call for call in launch_file(case).calls("DeclareLaunchArgument")}
        meant = next(iter(get_close_matches(argument, calls)), "")
        known = f"only {', '.join(declared)}" if declared else "no argument"
        yield at_call(case, calls.get(meant), argument=argument, declared=known)


@mistake(
    "argument-overwritten",
    explains=_NAMES,
    says="{line} sets {name} itself, for everything that is evaluated from then on: {code}",
    do="Leave the value to whoever starts the launch.",
    example=in_run(Symptom.WRONG_NAMES, argument="sound"),
)
def argument_overwritten(case: Case) -> Iterator[Found]:
    """A launch file sets its own argument.

    SetLaunchConfiguration replaces the value that was given on the command line, for everything after it and for event
    handlers.

    Bad:

        SetLaunchConfiguration('sound', 'ding')

    Good:

        DeclareLaunchArgument('sound', default_value='ding')

    See it: `ros2 launch FILE sound:=dong`, and see what is started.
    """
    name = case.about("argument", "")
    for call in launch_file(case).calls("SetLaunchConfiguration"):
        fixed = call.argument(1, "value").startswith(("'", '"'))
        if call.argument(0, "name") == f"'{name}'" and fixed and "condition" not in call.named:
            yield at_call(case, call, name=name)


@mistake(
    "value-in-the-wrong-place",
    explains=_NAMES,
    says="{line}: the Node has {keyword}={given}, which {why}",
    do="Put the argument's value where a node's names are set: its remappings, and its namespace.",
    example=in_run(Symptom.WRONG_NAMES, moves="topic", argument="topic", wanted="/dong"),
)
def wrong_place(case: Case) -> Iterator[Found]:
    """An argument's value is put in the wrong place.

    parameters= sets ROS parameters, arguments= is for what the program itself parses, name= is the node's name. A topic
    is renamed by remappings=, and a node is put into a namespace by namespace=. A text in quotation marks is just that
    text, not the value of the argument.

    Bad:

        Node(package='house', executable='bell', parameters=[{'topic': LaunchConfiguration('topic')}])

    Good:

        Node(package='house', executable='bell', remappings=[('ring', LaunchConfiguration('topic'))])

    See it: `ros2 node info NODE`.
    """
    argument, file = str(case.about("argument", "")), launch_file(case)
    right, effect = "remappings", "renames no topic"
    wanted = str(case.about("wanted", ""))
    arrived = any(endpoint.topic == wanted for endpoint in endpoints_of(case))
    if case.about("moves") == "namespace":
        right, effect = "namespace", "puts it into no namespace"
        arrived = any(endpoint.node.startswith(f"/{wanted}/") for endpoint in endpoints_of(case))
    for node in () if arrived else nodes_of(file):
        for keyword in ("parameters", "arguments", "ros_arguments", "name", "namespace", "remappings"):
            given = node.named.get(keyword, "")
            if keyword != right and _is_used(file, argument, given) and ":=" not in given:
                yield at_call(case, node, keyword=keyword, given=_short(given), why=effect)
            elif keyword == right and _is_fixed(given) and reaches_no_node(case):
                why = f"is a fixed text, and not the value of {argument}"
                yield at_call(case, node, keyword=keyword, given=_short(given), why=why)


def _is_fixed(code: str) -> bool:
    """Whether nothing in an argument's code is worked out when the file is executed."""
    return bool(code) and not any(isinstance(node, ast.Name | ast.Call) for node in ast.walk(ast.parse(code)))


def _short(code: str) -> str:
    return code if len(code) <= 60 else f"{code[:57]}..."
