"""Causes in what was printed where a log message was asked for."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from tutor.judge.causes import names
from tutor.judge.trace import OutputLine, Trace
from tutor.judge.verdict import Cause

_LOGGED = re.compile(r"^(?:\x1b\[\d+m)?\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] \[\d+\.\d+\] \[(?P<logger>[^\]]*)\]")
"""How the line begins that rclpy writes for a log message, beside sending it to /rosout."""


def of_printed(
    trace: Trace, says: Callable[[str], object], what: str, *, after: Iterable[OutputLine] = ()
) -> Cause | None:
    """Whether something that should have been logged was only printed; `says` knows it by its text.

    `what` it is, to be named in a sentence. `after`: what the process wrote later, when it was ended: what appears only
    there was held back in a buffer until then.
    """
    printed = [line.text for line in trace.output if _is_print(line) and says(line.text)]
    if printed:
        return Cause(
            "printed, not logged",
            f"{what} is written with print(): {printed[0]}",
            "use self.get_logger().info(...): log messages reach /rosout, where others can read them, and no buffering "
            "holds them back",
        )
    seen = {log.text for log in trace.logs}
    logged = [found for line in trace.output if (found := _LOGGED.match(line.text)) and says(line.text)]
    if logged and not any(found.string.endswith(each) for found in logged for each in seen):
        own = {node.strip("/").replace("/", ".") for node in trace.graph.nodes}
        if not trace.logs and any(found["logger"] in own for found in logged):
            return Cause(
                "rosout switched off",
                f"{what} is logged by the node, but nothing that it logs reaches /rosout: {logged[0].string}",
                "leave out enable_rosout=False, and --disable-rosout-logs among the arguments",
            )
        return Cause(
            "not the node's logger",
            f"{what} is logged by a logger that belongs to no node, so it does not reach /rosout: {logged[0].string}",
            "use self.get_logger(): rclpy.logging.get_logger(...) writes to the terminal only",
        )
    late = [line.text for line in after if _is_print(line) and says(line.text)]
    if late:
        return Cause(
            names.HELD_BACK,
            f"{what} is printed, not logged, and appears only when the program ends: {late[0]}",
            "use self.get_logger().info(...): print() into a pipe or a file waits until its buffer is full, a log "
            "message goes out at once",
        )
    return None


def _is_print(line: OutputLine) -> bool:
    return _LOGGED.match(line.text) is None
