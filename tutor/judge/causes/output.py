"""Causes for output that is printed where a log message is required."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Sequence

from tutor.judge import source, tracebacks
from tutor.judge.causes import names, printing, slips
from tutor.judge.rewriting.node import find_in_files, started_node
from tutor.judge.trace import Level, OutputLine, Trace
from tutor.judge.verdict import Cause

_LOG_LINE = re.compile(r"^(?:\x1b\[\d+m)?\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] \[\d+\.\d+\] \[(?P<logger>[^\]]*)\]")
"""Start of the line that rclpy writes to the terminal for a log message, in addition to sending it to /rosout."""

_ROS_LIBRARY_OUTPUT = re.compile(
    r"^Failed to publish log message to rosout|^>>> \[rcutils|^This error state is being overwritten"
    r"|^with this new error message|^rcutils_reset_error|^Exception ignored in|, at \S+\.(?:c|cpp|hpp):\d+$"
)
"""Messages of the ROS C and C++ libraries themselves, mostly when something is used after the shutdown."""

_PYTHON_WARNING = re.compile(r":\d+: \w*Warning: ")
"""A warning of Python or of a library, such as numpy's about a division by zero."""

_ROS_LOGGER = re.compile(r"^(?:rcl|rclcpp|rmw_\w+)(?:\.|$)")


def diagnose_printed(
    trace: Trace, says: Callable[[str], object], what: str, *, after: Iterable[OutputLine] = ()
) -> Cause | None:
    """Whether something that should have been logged was only printed; `says` recognises its text.

    `what`: a noun phrase for it, to be used in a sentence. `after`: the output after the process was told to end;
    whatever appears only there was held back in a buffer until then.
    """
    if (replaced := find_in_files(trace, printing.diagnose_own_logger)) is not None:
        return replaced
    printed = [text for text in _printed_lines(trace.output) if says(text)]
    if printed:
        if (call := printing.find_python_logging(trace, printed[0])) is not None:
            return _diagnose_python_logging(trace, call, what)
        print_call = printing.find_print(trace, printed[0])
        at = f" in line {print_call.lineno}" if print_call else ""
        step = (
            printing.log_instead_of_print(trace, print_call)
            if print_call
            else "use self.get_logger().info(...): log messages reach /rosout, where others can read them, and no "
            "buffering holds them back"
        )
        return Cause("printed, not logged", f"{what} is written with print(){at}: {printed[0]}", step)
    seen = {log.text for log in trace.logs}
    matches = [found for line in trace.output if (found := _LOG_LINE.match(line.text)) and says(line.text)]
    logged = [found for found in matches if not _ROS_LOGGER.match(found["logger"])]
    if logged and not any(found.string.endswith(each) for found in logged for each in seen):
        own = {node.strip("/").replace("/", ".") for node in trace.graph.nodes}
        if not trace.logs and any(found["logger"] in own for found in logged):
            return Cause(
                "rosout switched off",
                f"{what} is logged by the node, but nothing that it logs reaches /rosout: {logged[0].string}",
                printing.enable_rosout(started_node(trace))
                or "leave out enable_rosout=False, and --disable-rosout-logs among the arguments",
            )
        return Cause(
            "not the node's logger",
            f"{what} is logged by a logger that belongs to no node, so it does not reach /rosout: {logged[0].string}",
            printing.use_node_logger(started_node(trace))
            or "use self.get_logger(): rclpy.logging.get_logger(...) writes to the terminal only",
        )
    late = [text for text in _printed_lines(tuple(after)) if says(text)]
    if late:
        print_call = printing.find_print(trace, late[0])
        step = printing.log_instead_of_print(trace, print_call) if print_call else "use self.get_logger().info(...)"
        return Cause(
            names.HELD_BACK,
            f"{what} is printed, not logged, and appears only when the program ends: {late[0]}",
            f"{step}: print() into a pipe or a file waits until its buffer is full, a log message goes out at once",
        )
    lowest = min((log.level for log in trace.logs), default=Level.FATAL)
    if (raised := find_in_files(trace, lambda file: slips.diagnose_raised_level(file, lowest))) is not None:
        return raised
    unused = None if source.calls(trace, "get_logger") else printing.find_python_logging(trace)
    return _diagnose_python_logging(trace, unused, what) if unused is not None else None


def _diagnose_python_logging(trace: Trace, call: ast.Call, what: str) -> Cause:
    return Cause(
        "printed, not logged",
        f"{what} goes to Python's own logging module, which knows nothing of ROS: line {call.lineno}: "
        f"{ast.unparse(call)}",
        printing.log_instead_of_print(trace, call),
    )


def _printed_lines(output: Sequence[OutputLine]) -> list[str]:
    """The lines that the learner's code printed, without log messages, exceptions, and what ROS or Python writes."""
    raised = {each.raised for each in tracebacks.find_tracebacks(output)}
    return [
        text
        for text in tracebacks.lines_without_tracebacks(output)
        if text not in raised
        and not _LOG_LINE.match(text)
        and not _ROS_LIBRARY_OUTPUT.search(text)
        and not _PYTHON_WARNING.search(text)
    ]
