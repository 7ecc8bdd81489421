"""I2.2: likely causes, by name."""

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
_NOT_HERE = re.compile(r"(?<!\S)\S+ is not supported by the launch files that run without an installed ROS 2")
_ELSEWHERE = re.compile(r"`ros2 \w+` needs an installed ROS 2")
_NO_VALUE = re.compile(r"launch configuration '(?P<name>[^']*)' does not exist")
_NO_DEFAULT = re.compile(r"missing required argument '(?P<name>[^']*)'")
_NOT_PAIRS = re.compile(r"TypeError: Expected 'remap_rule'|remap_rule.*(?:tuple|unpack)")
_NO_TEXT = re.compile(
    r"TypeError: (?:can only concatenate str|sequence item|unsupported operand)[^\n]*"
    r"(?:LaunchConfiguration|Substitution)"
)
_UNRESOLVED = re.compile(r"<launch\S* object at 0x")
_NO_FUNCTION = re.compile(r"required function '?generate_launch_description|no attribute '?generate_launch_description")
_ERROR = re.compile(r"^\[ERROR\] \[launch\]: |Caught exception in launch[^:]*: ")
_REMAP = re.compile(r"(?:-r|--remap) (?P<source>[^\s:=]+):=(?P<target>\S+)")


def _uses_own_names[**P, R: Cause | None](diagnose: Callable[P, R]) -> Callable[P, R]:
    """What is said of a launch, with the names by which its file calls what it has imported."""

    @functools.wraps(diagnose)
    def said(*args: P.args, **named: P.kwargs) -> R:
        cause = diagnose(*args, **named)
        trace = next(
            each if isinstance(each, Trace) else each.trace
            for each in args[::-1]
            if isinstance(each, Trace | LaunchRun)
        )
        if cause is None:
            return cause
        there = launch(trace)
        return cast("R", steps.with_applicable_step(there, steps.with_own_names(there.source, cause)))

    return said


def diagnose_program(seen: LaunchRun, cause: Cause) -> Cause:
    """What is wrong with a program that the launch starts; where no line of it is known, the demos' are started."""
    there = launch(seen.trace)
    return steps.with_applicable_step(there, cause, there.demo)


@_uses_own_names
def diagnose_launch(trace: Trace) -> Cause | None:
    """Why the launch did not do what it should: its file is broken, or what it starts ends or cannot be found.

    Raises NeedsInstalledRos where it asks for what our substitute for `launch` does not have.
    """
    own = written_by(trace.output, None)
    text = "\n".join(line.text for line in own)
    there = launch(trace)
    if found := _NOT_HERE.search(text):
        raise NeedsInstalledRos(_line_of(text, found.start()))
    if found := _NO_VALUE.search(text):
        return steps.diagnose_undeclared_argument(there, found["name"])
    if found := _NO_DEFAULT.search(text):
        return steps.diagnose_missing_default(there, found["name"])
    if found := _NOT_PAIRS.search(text):
        return Cause(
            "remappings not a list of pairs",
            _line_of(text, found.start()),
            steps.remap_nodes(there, "chatter")
            or f"remappings takes a list of pairs, each in round brackets: {steps.remapping(there.source, 'chatter')}",
        )
    if any(_UNRESOLVED.search(line.text) for line in trace.output):
        return Cause(
            "substitution made text too early",
            "an f-string, str() or + has turned a substitution, such as LaunchConfiguration, into text like "
            "<launch.substitutions... object at 0x...>: its value is known only when the launch runs",
            steps.step_for_early_text(there, "chatter")
            or "give a list instead, whose parts are joined then: [LaunchConfiguration('namespace'), '/', 'name']",
        )
    if (found := _NO_TEXT.search(text)) and (hint := steps.step_for_early_text(there, "chatter")):
        return Cause("substitution is no text", _line_of(text, found.start()), hint)
    if found := _NO_PACKAGE.search(text):
        return Cause(
            "package not found",
            _line_of(text, found.start()),
            steps.step_for_other_program(there, "package", found["name"], nearest(found["name"], PACKAGES))
            or "check the spelling of package=; demo_nodes_py, demo_nodes_cpp and my_package are there",
        )
    if found := _NO_PROGRAM.search(text):
        return Cause(
            "executable not found",
            _line_of(text, found.start()),
            steps.step_for_other_program(there, "executable", found["name"], nearest(found["name"], PROGRAMS))
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
            steps.step_for_other_function(there)
            or "def generate_launch_description(): ... return LaunchDescription([...])",
        )
    if "NoneType" in text or re.search(r"return(?:s|ed)? (?:None|nothing)", text):
        return Cause(
            "nothing returned",
            "generate_launch_description() returns None",
            steps.step_for_missing_return(there) or "end it with: return LaunchDescription([...])",
        )
    if error := next((line.text for line in own if _ERROR.search(line.text)), None):
        return Cause(
            "error in the launch",
            _ERROR.sub("", error),
            f"fix this in {FILE}, then launch it yourself",
        )
    if dead := ended_processes(trace.output):
        return _diagnose_dead(dead[0], trace)
    for process in writers(trace.output):
        if left := tracebacks.find_tracebacks(by_stream(written_by(trace.output, process))):
            return causes.diagnose_traceback(left[-1], trace)
    if (piece := steps.diagnose_split_command(there)) is not None:
        return piece
    if trace.exit is not None:
        return Cause(
            "nothing to launch",
            f"the launch ended by itself after {trace.exit.after_s:.1f} s with {trace.exit}, and had started nothing",
            steps.step_for_empty_description(there)
            or "put both nodes into the list: LaunchDescription([publisher, subscriber])",
        )
    return None


def _line_of(text: str, at: int) -> str:
    line = text[text.rfind("\n", 0, at) + 1 : text.find("\n", at) if "\n" in text[at:] else len(text)]
    return _ERROR.sub("", _ERROR.sub("", line)).strip().removeprefix("- ")[:400]


def _diagnose_dead(dead: EndedProcess, trace: Trace) -> Cause:
    if dead.traceback is not None:
        named = causes.diagnose_traceback(dead.traceback, trace)
        return Cause("a node that ends", f"{dead.process} has ended: {named}", named.hint)
    words = [line.text for line in dead.output if line.text.strip()][-1:]
    if words and (elsewhere := _ELSEWHERE.search(words[0])):
        raise NeedsInstalledRos(elsewhere[0])
    return Cause(
        "a node that ends",
        f"{dead.process} has ended by itself with exit code {dead.code}" + (f": {words[0]}" if words else ""),
        "start this program alone, with ros2 run or python3, and see what it says",
    )


@_uses_own_names
def diagnose_missing(seen: LaunchRun) -> Cause:
    """Why there are not two nodes of which one publishes and one subscribes."""
    trace = seen.trace
    if (cause := diagnose_launch(trace)) is not None:
        return cause
    sending, taking = publishers(trace.graph), subscriptions(trace.graph)
    if not trace.graph.nodes:
        return Cause(
            "no node",
            "the launch runs, but no ROS node has come up",
            "start programs that are nodes, with Node(...)",
        )
    if (sending or taking) and not (sending and taking):
        missing, present = ("subscriber", sending) if sending else ("publisher", taking)
        verb = "subscribes" if sending else "publishes"
        there = launch(trace)
        if (cause := steps.diagnose_missing_node(there, missing)) is not None:
            return cause
        return Cause(
            f"no {missing}",
            f"there is {_nodes(present)}, but nothing {verb}",
            f"add a Node(...) for the {missing}, and put it into the list that LaunchDescription([...]) is given",
        )
    return Cause(
        "one node only",
        f"{_nodes([*sending, *taking])} does all by itself"
        if sending
        else f"the nodes {', '.join(trace.graph.nodes)} do neither",
        "start two programs, with a Node(...) for each",
    )


@_uses_own_names
def diagnose_topic(usual: LaunchRun, seen: LaunchRun, wanted: str) -> Cause:
    """Why, with another topic given, not both nodes use `wanted`, or the default topic is still used."""
    if (cause := _diagnose_broken(seen)) is not None:
        return cause
    graph, name, there = seen.trace.graph, _own_name(usual), launch(seen.trace)
    sends = [each for each in publishers(graph) if each.topic == wanted]
    takes = [each for each in subscriptions(graph) if each.topic == wanted]
    if not sends and not takes:
        return (
            _diagnose_added(there, graph, wanted)
            or _diagnose_ignored(seen, "topic", wanted, usual)
            or _diagnose_remaps(seen, wanted)
            or steps.diagnose_topic_argument(there, name)
            or Cause(
                "topic hard-coded",
                f"neither node uses {wanted}: the remappings do not depend on the argument",
                steps.remap_nodes(there, name) or f"give both nodes {steps.remapping(there.source, name)}",
            )
        )
    if not sends or not takes:
        present, others, verb = (
            (sends, subscriptions(graph), "subscribes to") if sends else (takes, publishers(graph), "publishes on")
        )
        stray = [each for each in others if each.node not in {one.node for one in present}] or others
        where = ", ".join(sorted({f"{each.node} {verb} {each.topic}" for each in stray})) or "the other is not there"
        return _diagnose_remaps(seen, wanted) or Cause(
            "remapping missing on one node",
            f"only {present[0].node} uses {wanted}; {where}",
            steps.remap_nodes(there, name)
            or "give the other node the same remappings=[...], from the name that its own code uses",
        )
    still = sorted(shared_topics(usual.trace.graph) & topics_in_use(graph))
    if still:
        who = sorted({each.node for each in (*publishers(graph), *subscriptions(graph)) if each.topic in still})
        return Cause(
            "default topic still used",
            f"{', '.join(who)} still {'uses' if len(who) == 1 else 'use'} {', '.join(still)}",
            steps.remap_nodes(there, name) or "give every node that uses the topic the same remappings=[...]",
        )
    return Cause(
        "no messages",
        f"both nodes are on {wanted}, but nothing is sent there",
        "start both by hand with this topic, and see what they say",
    )


@_uses_own_names
def diagnose_namespace(usual: LaunchRun, seen: LaunchRun) -> Cause:
    """Why, with a namespace given, not both nodes and their topic are under it."""
    if (cause := _diagnose_broken(seen)) is not None:
        return cause
    space, there = seen.arguments.get("namespace", NAMESPACE), launch(seen.trace)
    graph, under = seen.trace.graph, f"/{space}/"
    ends = [*publishers(graph), *subscriptions(graph)]
    twice = next((name for each in ends for name in (each.node, each.topic) if is_namespace_doubled(name, space)), None)
    if twice is not None:
        return Cause(
            "namespace applied twice",
            f"{twice} is in {under[:-1]} of {under[:-1]}",
            "use one of the two: namespace=LaunchConfiguration('namespace') for each node, or a PushRosNamespace",
        )
    within = [each for each in ends if each.node.startswith(under)]
    outside = [each for each in ends if not each.node.startswith(under)]
    if not within:
        return (
            _diagnose_ignored(seen, "namespace", space)
            or steps.diagnose_namespace_argument(there)
            or Cause(
                "namespace not used",
                f"{_nodes(outside)}: no node is under {under[:-1]}",
                steps.put_into_namespace(there)
                or "give both nodes namespace=LaunchConfiguration('namespace'), or put them behind a PushRosNamespace",
            )
        )
    if outside and not _both(within):
        return steps.diagnose_namespace_argument(there) or Cause(
            "namespace missing on one node",
            f"{_nodes(within)} is under {under[:-1]}, {_nodes(outside)} is not",
            steps.put_into_namespace(there)
            or "give the other node the same namespace=LaunchConfiguration('namespace')",
        )
    absolute = [each for each in within if not each.topic.startswith(under)]
    if absolute:
        slash = next((target for _, target in _remaps(seen) if target.startswith("/")), None)
        because = f"the remapping to {slash} begins with a slash" if slash else "its name begins with a slash"
        return Cause(
            "absolute topic",
            f"the nodes are under {under[:-1]}, but {absolute[0].node} uses {absolute[0].topic}: {because}",
            steps.remap_nodes(there, _own_name(usual)) or "a name that begins with / takes no namespace",
        )
    topic = seen.arguments.get("topic")
    if topic is not None:
        return diagnose_topic(usual, seen, f"{under}{topic}")
    return Cause(
        "nodes apart",
        f"{_uses(ends)}: no node subscribes to what another one publishes",
        "give both nodes the same namespace and the same remappings",
    )


def _diagnose_broken(seen: LaunchRun) -> Cause | None:
    """Where something ended, or the launch is broken, with these arguments only."""
    if seen.trace.exit is not None or ended_processes(seen.trace.output) or not seen.trace.graph.nodes:
        return diagnose_launch(seen.trace)
    return None


def _diagnose_added(there: Launch, graph: Graph, wanted: str) -> Cause | None:
    """Whether a topic has the value that was given as a part of its last name."""
    word = wanted.rsplit("/", 1)[-1]
    for each in (*publishers(graph), *subscriptions(graph)):
        last = each.topic.rsplit("/", 1)[-1]
        if word in last and word != last:
            return Cause(
                "wrong topic",
                f"{each.node} uses {each.topic}: something is added to the argument's value, {word}",
                "remap to LaunchConfiguration('topic') alone",
            )
    return None


def _diagnose_ignored(seen: LaunchRun, argument: str, value: str, usual: LaunchRun | None = None) -> Cause | None:
    """Whether the value that was given reaches no node at all."""
    there = launch(seen.trace)
    word = value.rsplit("/", 1)[-1]
    nodes = [command for command in seen.command_lines if seen.trace.file not in command]  # the launch has it by itself
    if any(word in command for command in nodes):
        return None
    name = _own_name(usual) if usual is not None else "chatter"
    source = there.source
    right = f"namespace={steps.value(source, argument)}" if argument == "namespace" else steps.remapping(source, name)
    declared = seen.trace.launch_arguments
    others = [name for name in declared if name not in ARGUMENTS]
    if argument not in declared and others:
        return Cause(
            "wrong argument name",
            f"{argument}:={word} changes nothing; the arguments are called {', '.join(declared)}",
            steps.step_for_other_name(there, argument, others)
            or f"name it exactly '{argument}', in DeclareLaunchArgument and in LaunchConfiguration",
        )
    if argument not in declared:
        return Cause(
            "argument missing",
            f"{argument}:={word} changes nothing: no such argument is declared",
            f"put {steps.declaration(argument)} first into the list in LaunchDescription([...]), and give every "
            f"Node(...) {right}",
        )
    if argument == "namespace":
        return steps.diagnose_namespace_argument(there) or Cause(
            "namespace not used",
            f"the argument {argument} is declared, but its value reaches no node",
            steps.put_into_namespace(there) or f"give every Node(...) {right}",
        )
    return steps.diagnose_topic_argument(there, name) or Cause(
        "topic hard-coded",
        f"the argument {argument} is declared, but its value reaches no node",
        steps.remap_nodes(there, name) or f"give every Node(...) {right}",
    )


def _own_name(usual: LaunchRun) -> str:
    """The name that the nodes' own code uses for their topic: what is remapped without arguments, or else its name."""
    topics = shared_topics(usual.trace.graph) or topics_in_use(usual.trace.graph)
    for source, target in _remaps(usual):
        if any(topic.rsplit("/", 1)[-1] == target.rsplit("/", 1)[-1] for topic in topics):
            return source.rsplit("/", 1)[-1]
    return min(topics, default="/chatter").rsplit("/", 1)[-1]


def _diagnose_remaps(seen: LaunchRun, wanted: str) -> Cause | None:
    """Whether a remapping to the topic starts from a name that its node does not use."""
    word = wanted.rsplit("/", 1)[-1]
    turned = [(source, target) for source, target in _remaps(seen) if source.rsplit("/", 1)[-1] == word]
    if turned:
        source, target = turned[0]
        return Cause(
            "remapping the wrong way round",
            f"{source} is remapped to {target}, so that {target} stays what it is",
            steps.remap_nodes(launch(seen.trace), target) or "first the name in the node's code, then the new one",
        )
    for source, target in _remaps(seen):
        if target.rsplit("/", 1)[-1] != word or source.startswith("__"):
            continue
        ends = [*publishers(seen.trace.graph), *subscriptions(seen.trace.graph)]
        idle = [each for each in ends if not each.topic.endswith(f"/{word}")]
        names = sorted({each.topic for each in idle})
        if not names:
            continue
        if source.startswith("/") and any(name.endswith(source) and name != source for name in names):
            return Cause(
                "absolute remapping",
                f"the remapping from {source} means this one name only; in the namespace, the topic is {names[0]}",
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


def _remaps(seen: LaunchRun) -> list[tuple[str, str]]:
    """The remappings on the nodes' command lines, from and to."""
    return [(m["source"], m["target"]) for command in seen.command_lines for m in _REMAP.finditer(command)]


@_uses_own_names
def diagnose_pair(seen: LaunchRun) -> Cause:
    """Why a publisher and a subscription of two nodes do not come together on one topic."""
    graph = seen.trace.graph
    sends, takes = publishers(graph), subscriptions(graph)
    return Cause(
        "wrong topic",
        f"{_uses(sends)}, {_uses(takes, 'subscribes to')}: nobody subscribes to what is published",
        "remap both to the same name: ('chatter', LaunchConfiguration('topic'))",
    )


def _both(ends: Sequence[TopicEndpoint]) -> bool:
    return len({each.node for each in ends}) > 1


def _nodes(ends: Sequence[TopicEndpoint]) -> str:
    return ", ".join(sorted({each.node for each in ends})) or "no node"


def _uses(ends: Sequence[TopicEndpoint], verb: str = "publishes on") -> str:
    return ", ".join(sorted({f"{each.node} {verb} {each.topic}" for each in ends}))
