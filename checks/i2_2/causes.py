"""I2.2: the likely causes of a failure."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Sequence
from typing import cast

from checks.i2_2 import steps
from checks.i2_2.facts import (
    ARGUMENTS,
    FILE,
    NAMESPACE,
    LaunchRun,
    is_namespace_doubled,
    publishers,
    shared_topics,
    subscriptions,
    topics_in_use,
)
from checks.i2_2.loading import find_refusal
from checks.i2_2.processes import EndedProcess, by_stream, ended_processes, writers, written_by
from checks.i2_2.rewriting import PACKAGES, PROGRAMS, Launch, launch, nearest
from tutor.judge import causes, tracebacks
from tutor.judge.bench import NeedsInstalledRos
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause
from tutor.ros_model import Graph, TopicEndpoint

_NO_PACKAGE = re.compile(r"package '(?P<name>[^']*)' not found", re.IGNORECASE)
_NO_PROGRAM = re.compile(r"executable '(?P<name>[^']*)' not found (?:in|on)[^\n]*")
_UNSUPPORTED = re.compile(r"(?<!\S)\S+ is not supported by the launch files that run without an installed ROS 2")
_NEEDS_ROS = re.compile(r"`ros2 \w+` needs an installed ROS 2")
_NO_VALUE = re.compile(r"launch configuration '(?P<name>[^']*)' does not exist")
_NO_DEFAULT = re.compile(r"missing required argument '(?P<name>[^']*)'")
_NOT_PAIRS = re.compile(r"TypeError: Expected 'remap_rule'|remap_rule.*(?:tuple|unpack)")
_NOT_TEXT = re.compile(
    r"TypeError: (?:can only concatenate str|sequence item|unsupported operand)[^\n]*"
    r"(?:LaunchConfiguration|Substitution)"
)
_UNRESOLVED = re.compile(r"<launch\S* object at 0x")
_NO_FUNCTION = re.compile(r"required function '?generate_launch_description|no attribute '?generate_launch_description")
_ERROR = re.compile(r"^\[ERROR\] \[launch\]: |Caught exception in launch[^:]*: ")
_REMAP = re.compile(r"(?:-r|--remap) (?P<source>[^\s:=]+):=(?P<target>\S+)")


def _with_imported_names[**P, R: Cause | None](diagnose: Callable[P, R]) -> Callable[P, R]:
    """Decorate a diagnosis so that its cause uses the names under which the launch file imports classes."""

    @functools.wraps(diagnose)
    def with_names(*args: P.args, **kwargs: P.kwargs) -> R:
        cause = diagnose(*args, **kwargs)
        trace = next(
            each if isinstance(each, Trace) else each.trace
            for each in args[::-1]
            if isinstance(each, Trace | LaunchRun)
        )
        if cause is None:
            return cause
        launch_file = launch(trace)
        return cast("R", steps.with_applicable_step(launch_file, steps.with_own_names(launch_file.source, cause)))

    return with_names


def diagnose_program(seen: LaunchRun, cause: Cause) -> Cause:
    """The cause of a fault in a launched program; unless its hint is an edit, the step is to launch the demo nodes."""
    launch_file = launch(seen.trace)
    return steps.with_applicable_step(launch_file, cause, launch_file.demo)


@_with_imported_names
def diagnose_launch(trace: Trace) -> Cause | None:
    """Why the launch failed: its file is broken, or a program that it starts exits or cannot be found.

    Raises NeedsInstalledRos if it needs a feature that our substitute for `launch` does not have.
    """
    own = written_by(trace.output, None)
    text = "\n".join(line.text for line in own)
    launch_file = launch(trace)
    if found := _UNSUPPORTED.search(text):
        raise NeedsInstalledRos(_line_of(text, found.start()))
    if found := _NO_VALUE.search(text):
        return steps.diagnose_undeclared_argument(launch_file, found["name"])
    if found := _NO_DEFAULT.search(text):
        return steps.diagnose_missing_default(launch_file, found["name"])
    if found := _NOT_PAIRS.search(text):
        return Cause(
            "remappings not a list of pairs",
            _line_of(text, found.start()),
            steps.remap_nodes(launch_file, "chatter")
            or "remappings takes a list of pairs, each in round brackets: "
            f"{steps.remapping(launch_file.source, 'chatter')}",
        )
    if any(_UNRESOLVED.search(line.text) for line in trace.output):
        return Cause(
            "substitution made text too early",
            "an f-string, str() or + has turned a substitution, such as LaunchConfiguration, into text like "
            "<launch.substitutions... object at 0x...>: its value is known only when the launch runs",
            steps.step_for_early_text(launch_file, "chatter")
            or "give a list instead, whose parts are joined when the launch runs: "
            "[LaunchConfiguration('namespace'), '/', 'name']",
        )
    if (found := _NOT_TEXT.search(text)) and (hint := steps.step_for_early_text(launch_file, "chatter")):
        return Cause("substitution is no text", _line_of(text, found.start()), hint)
    if found := _NO_PACKAGE.search(text):
        return Cause(
            "package not found",
            _line_of(text, found.start()),
            steps.rename_program(launch_file, "package", found["name"], nearest(found["name"], PACKAGES))
            or "check the spelling of package=; demo_nodes_py, demo_nodes_cpp and my_package are there",
        )
    if found := _NO_PROGRAM.search(text):
        return Cause(
            "executable not found",
            _line_of(text, found.start()),
            steps.rename_program(launch_file, "executable", found["name"], nearest(found["name"], PROGRAMS))
            or "check executable=: talker and listener in the demo packages, minimal_publisher and "
            "minimal_subscriber in my_package",
        )
    raised = tracebacks.find_tracebacks(by_stream(own))
    if raised:
        return causes.diagnose_traceback(raised[-1], trace)
    if (refusal := find_refusal(own, trace)) is not None:
        return causes.diagnose_traceback(refusal, trace)
    if _NO_FUNCTION.search(text):
        return Cause(
            "no generate_launch_description",
            f"{trace.file} has no function of this name, which launch calls",
            steps.rename_launch_function(launch_file)
            or "def generate_launch_description(): ... return LaunchDescription([...])",
        )
    if "NoneType" in text or re.search(r"return(?:s|ed)? (?:None|nothing)", text):
        return Cause(
            "nothing returned",
            "generate_launch_description() returns None",
            steps.add_return(launch_file) or "end it with: return LaunchDescription([...])",
        )
    if error := next((line.text for line in own if _ERROR.search(line.text)), None):
        return Cause(
            "error in the launch",
            _ERROR.sub("", error),
            f"fix this in {FILE}, then launch it yourself",
        )
    if ended := ended_processes(trace.output):
        return _diagnose_ended_process(ended[0], trace)
    for process in writers(trace.output):
        if left := tracebacks.find_tracebacks(by_stream(written_by(trace.output, process))):
            return causes.diagnose_traceback(left[-1], trace)
    if (piece := steps.diagnose_split_command(launch_file)) is not None:
        return piece
    if trace.exit is not None:
        return Cause(
            "nothing to launch",
            f"the launch ended by itself after {trace.exit.after_s:.1f} s with {trace.exit}, and had started nothing",
            steps.step_for_empty_description(launch_file)
            or "put both nodes into the list: LaunchDescription([publisher, subscriber])",
        )
    return None


def _line_of(text: str, at: int) -> str:
    line = text[text.rfind("\n", 0, at) + 1 : text.find("\n", at) if "\n" in text[at:] else len(text)]
    return _ERROR.sub("", _ERROR.sub("", line)).strip().removeprefix("- ")[:400]


def _diagnose_ended_process(ended: EndedProcess, trace: Trace) -> Cause:
    if ended.traceback is not None:
        named = causes.diagnose_traceback(ended.traceback, trace)
        return Cause("a node that ends", f"{ended.process} has ended: {named}", named.hint)
    words = [line.text for line in ended.output if line.text.strip()][-1:]
    if words and (elsewhere := _NEEDS_ROS.search(words[0])):
        raise NeedsInstalledRos(elsewhere[0])
    return Cause(
        "a node that ends",
        f"{ended.process} has ended by itself with exit code {ended.code}" + (f": {words[0]}" if words else ""),
        "start this program alone, with ros2 run or python3, and look at its output",
    )


@_with_imported_names
def diagnose_missing(seen: LaunchRun) -> Cause:
    """Why there are no two nodes of which one publishes and the other subscribes."""
    trace = seen.trace
    if (cause := diagnose_launch(trace)) is not None:
        return cause
    senders, receivers = publishers(trace.graph), subscriptions(trace.graph)
    if not trace.graph.nodes:
        return Cause(
            "no node",
            "the launch runs, but no ROS node has come up",
            "start programs that are nodes, with Node(...)",
        )
    if (senders or receivers) and not (senders and receivers):
        missing, present = ("subscriber", senders) if senders else ("publisher", receivers)
        verb = "subscribes" if senders else "publishes"
        launch_file = launch(trace)
        if (cause := steps.diagnose_missing_node(launch_file, missing)) is not None:
            return cause
        return Cause(
            f"no {missing}",
            f"there is {_list_nodes(present)}, but nothing {verb}",
            f"add a Node(...) for the {missing}, and put it into the list in LaunchDescription([...])",
        )
    return Cause(
        "one node only",
        f"{_list_nodes([*senders, *receivers])} does both by itself"
        if senders
        else f"the nodes {', '.join(trace.graph.nodes)} do neither",
        "start two programs, with a Node(...) for each",
    )


@_with_imported_names
def diagnose_topic(default_run: LaunchRun, seen: LaunchRun, wanted: str) -> Cause:
    """Why, with another topic given, one of the nodes does not use `wanted`, or the default topic is still used."""
    if (cause := _diagnose_broken(seen)) is not None:
        return cause
    graph, name, launch_file = seen.trace.graph, _original_topic(default_run), launch(seen.trace)
    senders = [each for each in publishers(graph) if each.topic == wanted]
    receivers = [each for each in subscriptions(graph) if each.topic == wanted]
    if not senders and not receivers:
        return (
            _diagnose_altered_topic(launch_file, graph, wanted)
            or _diagnose_ignored_argument(seen, "topic", wanted, default_run)
            or _diagnose_remapping(seen, wanted)
            or steps.diagnose_topic_argument(launch_file, name)
            or Cause(
                "topic hard-coded",
                f"neither node uses {wanted}: the remappings do not depend on the argument",
                steps.remap_nodes(launch_file, name) or f"give both nodes {steps.remapping(launch_file.source, name)}",
            )
        )
    if not senders or not receivers:
        present, others, verb = (
            (senders, subscriptions(graph), "subscribes to")
            if senders
            else (receivers, publishers(graph), "publishes on")
        )
        stray = [each for each in others if each.node not in {one.node for one in present}] or others
        where = ", ".join(sorted({f"{each.node} {verb} {each.topic}" for each in stray})) or "the other node is missing"
        return _diagnose_remapping(seen, wanted) or Cause(
            "remapping missing on one node",
            f"only {present[0].node} uses {wanted}; {where}",
            steps.remap_nodes(launch_file, name)
            or "give the other node the same remappings=[...], from the name that its own code uses",
        )
    still_used = sorted(shared_topics(default_run.trace.graph) & topics_in_use(graph))
    if still_used:
        users = sorted({each.node for each in (*publishers(graph), *subscriptions(graph)) if each.topic in still_used})
        return Cause(
            "default topic still used",
            f"{', '.join(users)} still {'uses' if len(users) == 1 else 'use'} {', '.join(still_used)}",
            steps.remap_nodes(launch_file, name) or "give every node that uses the topic the same remappings=[...]",
        )
    return Cause(
        "no messages",
        f"both nodes are on {wanted}, but nothing is sent there",
        "start both by hand with this topic, and look at their output",
    )


@_with_imported_names
def diagnose_namespace(default_run: LaunchRun, seen: LaunchRun) -> Cause:
    """Why, with a namespace given, one of the nodes or their topic is not in it."""
    if (cause := _diagnose_broken(seen)) is not None:
        return cause
    namespace, launch_file = seen.arguments.get("namespace", NAMESPACE), launch(seen.trace)
    graph, under = seen.trace.graph, f"/{namespace}/"
    endpoints = [*publishers(graph), *subscriptions(graph)]
    twice = next(
        (name for each in endpoints for name in (each.node, each.topic) if is_namespace_doubled(name, namespace)), None
    )
    if twice is not None:
        return Cause(
            "namespace applied twice",
            f"{twice} has the prefix {under[:-1]} twice",
            "use one of the two: namespace=LaunchConfiguration('namespace') for each node, or a PushRosNamespace",
        )
    within = [each for each in endpoints if each.node.startswith(under)]
    outside = [each for each in endpoints if not each.node.startswith(under)]
    if not within:
        return (
            _diagnose_ignored_argument(seen, "namespace", namespace)
            or steps.diagnose_namespace_argument(launch_file)
            or Cause(
                "namespace not used",
                f"{_list_nodes(outside)}: no node is under {under[:-1]}",
                steps.put_into_namespace(launch_file)
                or "give both nodes namespace=LaunchConfiguration('namespace'), or put them behind a PushRosNamespace",
            )
        )
    if outside and not _are_two_nodes(within):
        return steps.diagnose_namespace_argument(launch_file) or Cause(
            "namespace missing on one node",
            f"{_list_nodes(within)} is under {under[:-1]}, {_list_nodes(outside)} is not",
            steps.put_into_namespace(launch_file)
            or "give the other node the same namespace=LaunchConfiguration('namespace')",
        )
    absolute = [each for each in within if not each.topic.startswith(under)]
    if absolute:
        slash = next((target for _, target in _remappings(seen) if target.startswith("/")), None)
        because = f"the remapping to {slash} begins with a slash" if slash else "its name begins with a slash"
        return Cause(
            "absolute topic",
            f"the nodes are under {under[:-1]}, but {absolute[0].node} uses {absolute[0].topic}: {because}",
            steps.remap_nodes(launch_file, _original_topic(default_run))
            or "a name that begins with / takes no namespace",
        )
    topic = seen.arguments.get("topic")
    if topic is not None:
        return diagnose_topic(default_run, seen, f"{under}{topic}")
    return Cause(
        "nodes apart",
        f"{_list_endpoints(endpoints)}: no node subscribes to what another one publishes",
        "give both nodes the same namespace and the same remappings",
    )


def _diagnose_broken(seen: LaunchRun) -> Cause | None:
    """Why a process ended, or no node came up, with these arguments."""
    if seen.trace.exit is not None or ended_processes(seen.trace.output) or not seen.trace.graph.nodes:
        return diagnose_launch(seen.trace)
    return None


def _diagnose_altered_topic(launch_file: Launch, graph: Graph, wanted: str) -> Cause | None:
    """Find a topic whose base name contains the given value, but is not equal to it."""
    base_name = wanted.rsplit("/", 1)[-1]
    for each in (*publishers(graph), *subscriptions(graph)):
        last = each.topic.rsplit("/", 1)[-1]
        if base_name in last and base_name != last:
            return Cause(
                "wrong topic",
                f"{each.node} uses {each.topic}: something is added to the argument's value, {base_name}",
                "remap to LaunchConfiguration('topic') alone",
            )
    return None


def _diagnose_ignored_argument(
    seen: LaunchRun, argument: str, value: str, default_run: LaunchRun | None = None
) -> Cause | None:
    """Find out why the argument's value reaches no node at all; None if it reaches one."""
    launch_file = launch(seen.trace)
    base_name = value.rsplit("/", 1)[-1]
    # `ros2 launch` itself always has the value.
    nodes = [command for command in seen.command_lines if seen.trace.file not in command]
    if any(base_name in command for command in nodes):
        return None
    name = _original_topic(default_run) if default_run is not None else "chatter"
    source = launch_file.source
    right = f"namespace={steps.value(source, argument)}" if argument == "namespace" else steps.remapping(source, name)
    declared = seen.trace.launch_arguments
    others = [name for name in declared if name not in ARGUMENTS]
    if argument not in declared and others:
        return Cause(
            "wrong argument name",
            f"{argument}:={base_name} changes nothing; the arguments are called {', '.join(declared)}",
            steps.rename_similar_argument(launch_file, argument, others)
            or f"name it exactly '{argument}', in DeclareLaunchArgument and in LaunchConfiguration",
        )
    if argument not in declared:
        return Cause(
            "argument missing",
            f"{argument}:={base_name} changes nothing: no such argument is declared",
            f"put {steps.declaration(argument)} first into the list in LaunchDescription([...]), and give every "
            f"Node(...) {right}",
        )
    if argument == "namespace":
        return steps.diagnose_namespace_argument(launch_file) or Cause(
            "namespace not used",
            f"the argument {argument} is declared, but its value reaches no node",
            steps.put_into_namespace(launch_file) or f"give every Node(...) {right}",
        )
    return steps.diagnose_topic_argument(launch_file, name) or Cause(
        "topic hard-coded",
        f"the argument {argument} is declared, but its value reaches no node",
        steps.remap_nodes(launch_file, name) or f"give every Node(...) {right}",
    )


def _original_topic(default_run: LaunchRun) -> str:
    """The topic name in the nodes' own code: the source of a remapping without arguments, else the topic itself."""
    topics = shared_topics(default_run.trace.graph) or topics_in_use(default_run.trace.graph)
    for source, target in _remappings(default_run):
        if any(topic.rsplit("/", 1)[-1] == target.rsplit("/", 1)[-1] for topic in topics):
            return source.rsplit("/", 1)[-1]
    return min(topics, default="/chatter").rsplit("/", 1)[-1]


def _diagnose_remapping(seen: LaunchRun, wanted: str) -> Cause | None:
    """Find a remapping to the topic that has no effect, since its node does not use the source name."""
    base_name = wanted.rsplit("/", 1)[-1]
    swapped = [(source, target) for source, target in _remappings(seen) if source.rsplit("/", 1)[-1] == base_name]
    if swapped:
        source, target = swapped[0]
        return Cause(
            "remapping the wrong way round",
            f"{source} is remapped to {target}, so {target} keeps its name",
            steps.remap_nodes(launch(seen.trace), target) or "first the name in the node's code, then the new one",
        )
    for source, target in _remappings(seen):
        if target.rsplit("/", 1)[-1] != base_name or source.startswith("__"):
            continue
        endpoints = [*publishers(seen.trace.graph), *subscriptions(seen.trace.graph)]
        unremapped = [each for each in endpoints if not each.topic.endswith(f"/{base_name}")]
        names = sorted({each.topic for each in unremapped})
        if not names:
            continue
        if source.startswith("/") and any(name.endswith(source) and name != source for name in names):
            return Cause(
                "absolute remapping",
                f"the remapping from {source} applies to exactly this name; in the namespace, the topic is {names[0]}",
                steps.remap_nodes(launch(seen.trace), source[1:])
                or "without the slash, the name is taken within the namespace",
            )
        if not any(name.rsplit("/", 1)[-1] == source.rsplit("/", 1)[-1] for name in names):
            return Cause(
                "remapping from an unused name",
                f"{source} is remapped to {target}, but the node uses {', '.join(names)}",
                steps.remap_nodes(launch(seen.trace), names[0].rsplit("/", 1)[-1])
                or f"remap {names[0].rsplit('/', 1)[-1]} instead",
            )
    return None


def _remappings(seen: LaunchRun) -> list[tuple[str, str]]:
    """The remappings on the nodes' command lines, as (source, target)."""
    return [(m["source"], m["target"]) for command in seen.command_lines for m in _REMAP.finditer(command)]


@_with_imported_names
def diagnose_pair(seen: LaunchRun) -> Cause:
    """Why no publisher and subscription of two nodes share a topic."""
    graph = seen.trace.graph
    senders, receivers = publishers(graph), subscriptions(graph)
    return Cause(
        "wrong topic",
        f"{_list_endpoints(senders)}, {_list_endpoints(receivers, 'subscribes to')}: "
        "no node subscribes to what is published",
        "remap both to the same name: ('chatter', LaunchConfiguration('topic'))",
    )


def _are_two_nodes(endpoints: Sequence[TopicEndpoint]) -> bool:
    return len({each.node for each in endpoints}) > 1


def _list_nodes(endpoints: Sequence[TopicEndpoint]) -> str:
    return ", ".join(sorted({each.node for each in endpoints})) or "no node"


def _list_endpoints(endpoints: Sequence[TopicEndpoint], verb: str = "publishes on") -> str:
    return ", ".join(sorted({f"{each.node} {verb} {each.topic}" for each in endpoints}))
