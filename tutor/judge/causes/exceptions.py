"""Causes that a traceback gives away."""

from __future__ import annotations

from tutor.judge.causes import names, parameters
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Traceback
from tutor.judge.verdict import Cause


def of_traceback(found: Traceback, trace: Trace) -> Cause:
    """Name an exception, with the learner's own line; of a chain, the one that tells most, from its origin on."""
    chain = [found]
    while (before := chain[-1].follows) is not None:
        chain.append(before)
    for each in reversed(chain):
        if (cause := _known(each, _told(each, found, trace))) is not None:
            return cause
    return Cause(
        names.UNHANDLED_EXCEPTION,
        _told(found.origin, found, trace),
        "mend this line, or catch the exception where you can do something about it",
    )


def _told(each: Traceback, last: Traceback, trace: Trace) -> str:
    """The exception with the learner's line, and what it led to."""
    own = each.own(trace.folder) or last.own(trace.folder)
    after = "" if each is last else f"; then {last.raised}"
    return each.raised + (f" ({own})" if own else "") + after


def _known(found: Traceback, told: str) -> Cause | None:
    kind, message = found.type.rsplit(".", 1)[-1], found.message
    if kind in ("SyntaxError", "IndentationError", "TabError"):
        return Cause(names.SYNTAX_ERROR, told, "mend this line (or the one before it), then check again")
    if kind in ("ImportError", "ModuleNotFoundError"):
        return Cause(names.IMPORT_ERROR, told, "check the spelling of the module and of the name that you import")
    if kind == "InvalidParameterTypeException":
        return parameters.of_types(told)
    if kind == "SystemError" or (kind == "AssertionError" and "type 'int'" in message):
        return Cause(names.FLOAT_IN_INT, told, "an int64 field takes whole numbers only: use a // b or int(...)")
    if kind == "TypeError" and found.frames and found.frames[-1].function == "send_response":
        return Cause(
            "response not returned",
            f"unhandled exception in rclpy, {told}: a service callback returned something else than its response",
            "end every way through the callback with: return response",
        )
    return None
