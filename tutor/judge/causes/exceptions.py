"""Causes that a traceback gives away."""

from __future__ import annotations

import re
from dataclasses import replace

from tutor.judge import exceptions
from tutor.judge.causes import names, parameters
from tutor.judge.rewriting.node import node_file
from tutor.judge.rewriting.parameters import declare_once
from tutor.judge.rewriting.syntax import make_readable
from tutor.judge.step_parsing import is_applicable
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.judge.verdict import Cause

_UNREAD = ("SyntaxError", "IndentationError", "TabError")
_EDITS = re.compile(r"lines? \d+|write (?:above|below) line|remove lines? \d+|at the top of the file")


def diagnose_traceback(found: Traceback, trace: Trace) -> Cause:
    """Name an exception, with the learner's own line; of a chain, the one that tells most, from its origin on."""
    if (cause := diagnose_known_exception(found, trace)) is not None:
        return cause
    own = found.origin.own(trace.folder) or found.own(trace.folder)
    return Cause(
        names.UNHANDLED_EXCEPTION,
        _told(found.origin, found, trace),
        _general(found.origin, own),
    )


def _general(raised: Traceback, own: Frame | None) -> str:
    """What to do about an exception that nothing more is known of: where Python stops, and what it complains of."""
    said = raised.raised.rstrip(".")
    if own is None:
        return f"look in the last lines of the output for the line of yours that leads to it, and change that: {said}"
    return f"in line {own.line} of {own.name}, change what Python complains of there: {said}"


def diagnose_known_exception(found: Traceback, trace: Trace) -> Cause | None:
    """What the table of known exceptions says of the first of a chain that it knows."""
    chain = [found]
    while (before := chain[-1].follows) is not None:
        chain.append(before)
    return next((cause for each in reversed(chain) if (cause := _known(each, found, trace)) is not None), None)


def _told(each: Traceback, last: Traceback, trace: Trace) -> str:
    """The exception with the learner's line, and what it led to."""
    own = each.own(trace.folder) or last.own(trace.folder)
    return each.raised + (f" ({own})" if own else "") + _after(each, last)


def _after(each: Traceback, last: Traceback) -> str:
    return "" if each is last else f"; then {last.raised}"


def _known(each: Traceback, last: Traceback, trace: Trace) -> Cause | None:
    own = each.own(trace.folder) or last.own(trace.folder)
    file = own.name if own and own.name in trace.sources else trace.file
    seen = exceptions.RaisedException(each, trace.folder, own, file, trace.sources.get(file, ""))
    # Whatever the program raises itself, on account of another exception, tells less than that one.
    table = [k for k in (*trace.exceptions, *exceptions.load_shipped()) if k.type != ".*" or each is last.origin]
    found = exceptions.explain(seen, table, cause=names.UNHANDLED_EXCEPTION, after=_after(each, last))
    if found is None and each.type.endswith("InvalidParameterTypeException"):
        return parameters.diagnose_types(_told(each, last, trace))
    if found is not None and each.type.endswith("ParameterAlreadyDeclaredException") and own is not None:
        read = node_file(seen.source)
        found = replace(found, hint=read.step(declare_once(read, own.line)) or found.hint)
    if found is not None and each.type.endswith(_UNREAD) and not is_applicable(found.hint, {file: seen.source}):
        found = replace(found, hint=make_readable(seen.source) or found.hint)
    if found is not None and len(trace.sources) > 1 and _EDITS.match(found.hint):
        return replace(found, hint=f"in {file}, {found.hint}")
    return found
