"""What the entries about launch files ask of a case: its launch file, what launch itself says, names in the graph."""

from __future__ import annotations

import re
from typing import Any

from tutor.judge.launch_output import written_by
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Exit
from tutor.mistakes.entry import Case, Found
from tutor.ros_model import Graph, TopicEndpoint, is_standard_topic
from tutor.source.launch_file import Call, LaunchFile

LAUNCH = (Symptom.NOT_LAUNCHED, Symptom.WRONG_NAMES, Symptom.NOT_CONNECTED)
"""The symptoms of a launch that does not work."""

ERROR = re.compile(r"^\[ERROR\] \[launch\]: |Caught exception in launch[^:]*: ")
REMAP = re.compile(r"(?:-r|--remap) (?P<source>[^\s:=]+):=(?P<target>\S+)")


def launch_file(case: Case) -> LaunchFile:
    """The launch file that was started."""
    return LaunchFile(case.file.text)


def at_call(case: Case, call: Call | None, **words: object) -> Found:
    """A mistake at a call of the launch file; without a place if there is none."""
    if call is None:
        return Found(dict(words))
    return Found(dict(words), case.file.name, call.line, case.file.line(call.line))


def _own_text(case: Case) -> str:
    return "\n".join(line.text for line in written_by(case.trace.output, None))


def says_itself(pattern: re.Pattern[str], case: Case) -> re.Match[str] | None:
    """What launch itself says, if the launch is broken."""
    return pattern.search(_own_text(case)) if case.trace.exit is not None or not case.trace.graph.nodes else None


def line_of(found: re.Match[str]) -> str:
    """The line of launch's output in which this was found."""
    text, at = found.string, found.start()
    line = text[text.rfind("\n", 0, at) + 1 :].partition("\n")[0]
    return ERROR.sub("", ERROR.sub("", line)).strip().removeprefix("- ")[:200]


def output_of(*lines: str) -> dict[str, Any]:
    """The launch of an example that wrote these lines and ended."""
    return {"output": lines, "graph": Graph(), "exit": Exit(1, None, 0.5)}


def endpoints_of(case: Case) -> list[TopicEndpoint]:
    """The publishers and subscriptions, without those of ROS itself."""
    graph = case.trace.graph
    return [endpoint for endpoint in (*graph.publishers, *graph.subscriptions) if not is_standard_topic(endpoint.topic)]


def value_of(case: Case) -> str:
    """The value that was given for the argument."""
    return str(case.about("wanted", "")).rpartition("/")[2]


def reaches_no_node(case: Case) -> bool:
    """Whether the argument's value is on the command line of no node (launch itself always has it)."""
    nodes = [command for command in case.about("command_lines", ()) if case.trace.file not in command]
    return not any(value_of(case) in command for command in nodes)


def remappings_of(case: Case) -> list[tuple[str, str]]:
    """The remappings of topics on the nodes' command lines, as (source, target)."""
    rules = [found for command in case.about("command_lines", ()) for found in REMAP.finditer(command)]
    return [(found["source"], found["target"]) for found in rules if not found["source"].startswith("__")]


def last_part(name: str) -> str:
    """The name without its namespace."""
    return name.rpartition("/")[2]


def nodes_of(file: LaunchFile) -> list[Call]:
    """The calls that describe a node."""
    return file.calls("Node", "LifecycleNode")
