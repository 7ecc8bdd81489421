"""Likely causes, by name: pure recognisers from what was seen to a `Cause`, shared by all checks."""

from __future__ import annotations

import difflib
import signal
from collections.abc import Iterable

from tutor.judge import tracebacks
from tutor.judge.trace import Endpoint, Trace
from tutor.judge.verdict import Cause

QUICK_S = 3.0
"""A process that ends by itself within this many seconds of its start ended "at once"."""


def of_process(trace: Trace) -> Cause | None:
    """Why the process as such did not do its work: it could not start, broke, ended, or never made a node."""
    found = tracebacks.last(trace)
    if found is not None:
        return of_traceback(found, trace)
    if trace.exit is not None:
        return _of_exit(trace)
    if not trace.graph.nodes:
        return Cause(
            "no node",
            f"the process runs, but made no ROS node{_busy_printing(trace)}",
            "call rclpy.init(), create your node, then rclpy.spin(node); a loop before that keeps it from happening",
        )
    return None


def of_traceback(found: tracebacks.Traceback, trace: Trace) -> Cause:
    """Name an exception, with the learner's own line."""
    own = found.own(trace.folder)
    where = f" ({own})" if own else ""
    if found.type in ("SyntaxError", "IndentationError", "TabError"):
        return Cause(
            "syntax error", f"{found.raised}{where}", "mend this line (or the one before it), then check again"
        )
    if found.type in ("ImportError", "ModuleNotFoundError"):
        return Cause(
            "import error", f"{found.raised}{where}", "check the spelling of the module and of the name that you import"
        )
    if found.type.endswith("InvalidParameterTypeException") and "expecting type 'STRING'" in found.message:
        return Cause(
            "wrong parameter type",
            f"{found.raised}{where}",
            "the type of the default is the type of the parameter: declare a number, such as 1.0, not a text",
        )
    if found.type.endswith("InvalidParameterTypeException"):
        return Cause(
            "integer parameter",
            f"{found.raised}{where}",
            "the type of the default is the type of the parameter: declare 1.0, not 1, where a rate may have decimals",
        )
    if found.type == "SystemError" or (found.type == "AssertionError" and "type 'int'" in found.message):
        return Cause(
            "float in an int field",
            f"{found.raised}{where}",
            "an int64 field takes whole numbers only: use a // b or int(...)",
        )
    return Cause(
        "unhandled exception",
        f"{found.raised}{where}",
        "mend this line, or catch the exception where you can do something about it",
    )


def _of_exit(trace: Trace) -> Cause:
    assert trace.exit is not None
    ended = f"the process ended after {trace.exit.after_s:.1f} s with {trace.exit}"
    if trace.uncalled_main:
        return Cause(
            "no main call",
            f"{ended}: main() is defined, but nothing calls it",
            'end the file with: if __name__ == "__main__": main()',
        )
    if trace.exit.signal is not None:
        return Cause("killed", f"{ended} ({_signal_name(trace.exit.signal)})", "see the last lines of its output")
    if trace.exit.code == 0 and trace.exit.after_s <= QUICK_S + 0.5:
        return Cause(
            "exit at once",
            f"{ended}, without an error",
            "a node lives as long as rclpy.spin(node) runs: is it called, and is anything ending it?",
        )
    return Cause("exit at once", ended, "let rclpy.spin(node) run until Ctrl+C; see the last lines of its output")


def of_silence(trace: Trace, topic: str, type_name: str, *, answers: bool) -> Cause:
    """Why nothing of `type_name` came on `topic`. `answers`: whether a node of the learner's answered a request."""
    if (cause := of_process(trace)) is not None:
        return cause
    publishers = trace.graph.publishers
    here = [endpoint for endpoint in publishers if endpoint.topic == topic]
    if any(endpoint.type == type_name for endpoint in here):
        if not answers:
            return no_spin(trace)
        return Cause(
            "no messages",
            f"there is a publisher on {topic}, but it sent nothing",
            "does the timer's callback call publish(), and is the timer kept in self?",
        )
    if here:
        return Cause(
            "wrong type",
            f"{topic} has the type {here[0].type}, not {type_name}",
            f"create the publisher with {type_name.rsplit('/', 1)[-1]} from {type_name.split('/')[0]}.msg",
        )
    same_type = [endpoint for endpoint in publishers if endpoint.type == type_name]
    if same_type:
        return wrong_topic(same_type, topic)
    near = [endpoint for endpoint in publishers if difflib.get_close_matches(endpoint.topic, [topic], cutoff=0.6)]
    if near:
        return wrong_topic(near, topic)
    return Cause(
        "no publisher",
        f"{_names(trace.graph.nodes)} is up, but has no publisher on {topic}",
        f"create one in __init__: self.create_publisher({type_name.rsplit('/', 1)[-1]}, '{topic}', 10)",
    )


def wrong_topic(endpoints: Iterable[Endpoint], topic: str) -> Cause:
    """The publisher is there, under another name; what kind of slip it is follows from the name."""
    names = sorted({endpoint.topic for endpoint in endpoints})
    name = min(names, key=lambda each: -difflib.SequenceMatcher(None, each, topic).ratio())
    if name.endswith(topic):
        slip = (
            "it has a namespace or the node's name in front: a name that begins with ~ or has no / in front is relative"
        )
    elif name.strip("/") == topic.strip("/").replace("/", "_") or name.replace("/", "") == topic.replace("/", ""):
        slip = "the slash between its parts is missing"
    elif topic.endswith(name):
        slip = "the first part of the name is missing"
    else:
        slip = "the name is spelled differently"
    return Cause(
        "wrong topic",
        f"messages of this type go to {', '.join(names)}, not to {topic}: {slip}",
        f"use exactly '{topic}' in create_publisher",
    )


def no_spin(trace: Trace) -> Cause:
    """The node exists, but none of its callbacks ever runs."""
    return Cause(
        "no spin",
        f"{_names(trace.graph.nodes)} exists, but answers no request: its callbacks are never run",
        "call rclpy.spin(node) (or executor.spin()) after creating the node, and let no callback block",
    )


def same_name(trace: Trace) -> Cause | None:
    """Two nodes under one name: both publish, and whoever asks one of them cannot tell which answers."""
    nodes = trace.graph.nodes
    twice = sorted({node for node in nodes if nodes.count(node) > 1})
    if not twice:
        return None
    return Cause(
        "second node of the same name",
        f"there are {nodes.count(twice[0])} nodes called {twice[0]}, and all of them are at work",
        "make one node only; is the class instantiated twice, or the program started twice?",
    )


def last_words(trace: Trace, most: int = 6) -> tuple[str, ...]:
    """The last lines that the process wrote, as evidence."""
    return tuple(line.text for line in trace.output if line.text.strip())[-most:]


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def _names(nodes: tuple[str, ...]) -> str:
    return "the node " + ", ".join(nodes) if nodes else "the node"


def _busy_printing(trace: Trace) -> str:
    return " and prints without end" if trace.dropped_lines else ""
