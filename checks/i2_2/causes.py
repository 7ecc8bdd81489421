"""I2.2: why a launch fails, or starts no two nodes that could talk to each other."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Sequence
from typing import cast

from checks.i2_2 import declarations, source_causes, steps
from checks.i2_2.facts import (
    FILE,
    LaunchRun,
    publishers,
    subscriptions,
)
from checks.i2_2.launch_file import launch
from checks.i2_2.loading import find_refusal
from checks.i2_2.processes import EndedProcess, by_stream, ended_processes, writers, written_by
from tutor.judge import causes, tracebacks
from tutor.judge.bench import NeedsInstalledRos
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause
from tutor.ros_model import TopicEndpoint

_NO_PACKAGE = re.compile(r"package '(?P<name>[^']*)' not found", re.IGNORECASE)
_NO_PROGRAM = re.compile(r"executable '(?P<name>[^']*)' not found (?:in|on)[^\n]*")
_UNSUPPORTED = re.compile(r"(?<!\S)\S+ is not supported by the launch files that run without an installed ROS 2")
_NEEDS_ROS = re.compile(r"`ros2 \w+` needs an installed ROS 2")
_NO_VALUE = re.compile(r"launch configuration '(?P<name>[^']*)' does not exist")
_NO_DEFAULT = re.compile(r"missing required argument '(?P<name>[^']*)'")
_INVALID_RULE = re.compile(r"Couldn't parse remap rule: '-r [^\s:=]+:=(?P<target>[^']+)'")
_NOT_PAIRS = re.compile(r"TypeError: Expected 'remap_rule'|remap_rule.*(?:tuple|unpack)")
_NOT_TEXT = re.compile(
    r"TypeError: (?:can only concatenate str|sequence item|unsupported operand)[^\n]*"
    r"(?:LaunchConfiguration|Substitution)"
)
_UNRESOLVED = re.compile(r"<launch\S* object at 0x")
_NO_FUNCTION = re.compile(r"required function '?generate_launch_description|no attribute '?generate_launch_description")
_ERROR = re.compile(r"^\[ERROR\] \[launch\]: |Caught exception in launch[^:]*: ")


def with_imported_names[**P, R: Cause | None](diagnose: Callable[P, R]) -> Callable[P, R]:
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


@with_imported_names
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
        return declarations.diagnose_undeclared_argument(launch_file, found["name"])
    if found := _NO_DEFAULT.search(text):
        return declarations.diagnose_missing_default(launch_file, found["name"])
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
    if found := _INVALID_RULE.search("\n".join(line.text for line in trace.output)):
        name = found["target"].strip("/")
        return Cause(
            "invalid name",
            f"'{name}' is no valid name in ROS: letters, digits and _ only, and no digit first",
            steps.replace_default(launch_file, name) or f"choose another name than '{name}'",
        )
    if (found := _NOT_TEXT.search(text)) and (hint := steps.step_for_early_text(launch_file, "chatter")):
        return Cause("substitution is no text", _line_of(text, found.start()), hint)
    if found := _NO_PACKAGE.search(text):
        return Cause(
            "package not found",
            _line_of(text, found.start()),
            steps.rename_package(launch_file, found["name"])
            or "check the spelling of package=; demo_nodes_py, demo_nodes_cpp and my_package are there",
        )
    if found := _NO_PROGRAM.search(text):
        return Cause(
            "executable not found",
            _line_of(text, found.start()),
            steps.rename_programs(launch_file, found["name"])
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
    if (piece := source_causes.diagnose_split_command(launch_file)) is not None:
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


@with_imported_names
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
        if (cause := source_causes.diagnose_missing_node(launch_file, missing)) is not None:
            return cause
        return Cause(
            f"no {missing}",
            f"there is {list_nodes(present)}, but nothing {verb}",
            f"add a Node(...) for the {missing}, and put it into the list in LaunchDescription([...])",
        )
    return Cause(
        "one node only",
        f"{list_nodes([*senders, *receivers])} does both by itself"
        if senders
        else f"the nodes {', '.join(trace.graph.nodes)} do neither",
        "start two programs, with a Node(...) for each",
    )


@with_imported_names
def diagnose_pair(seen: LaunchRun) -> Cause:
    """Why no publisher and subscription of two nodes share a topic."""
    graph = seen.trace.graph
    senders, receivers = publishers(graph), subscriptions(graph)
    return Cause(
        "wrong topic",
        f"{list_endpoints(senders)}, {list_endpoints(receivers, 'subscribes to')}: "
        "no node subscribes to what is published",
        "remap both to the same name: ('chatter', LaunchConfiguration('topic'))",
    )


@with_imported_names
def diagnose_simulation_time(seen: LaunchRun, node: str) -> Cause | None:
    """Whether a node publishes nothing because it waits for the clock of a simulation."""
    return source_causes.diagnose_simulation_time(launch(seen.trace), seen.trace.graph, node)


def list_nodes(endpoints: Sequence[TopicEndpoint]) -> str:
    """The names of their nodes, such as "/listener, /talker"."""
    return ", ".join(sorted({each.node for each in endpoints})) or "no node"


def list_endpoints(endpoints: Sequence[TopicEndpoint], verb: str = "publishes on") -> str:
    """What their nodes do, such as "/talker publishes on /chatter"."""
    return ", ".join(sorted({f"{each.node} {verb} {each.topic}" for each in endpoints}))
