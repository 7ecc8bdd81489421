"""Causes that a traceback reveals."""

from __future__ import annotations

import ast
import re
from dataclasses import replace

from tutor.judge import edits, exceptions
from tutor.judge.causes import names, parameters
from tutor.judge.rewriting.node import node_file
from tutor.judge.rewriting.parameters import declare_once
from tutor.judge.rewriting.syntax import make_readable
from tutor.judge.source import SourceFile
from tutor.judge.step_parsing import is_applicable
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.judge.verdict import Cause

_SYNTAX_ERRORS = ("SyntaxError", "IndentationError", "TabError")
_EDITS = re.compile(r"lines? \d+|write (?:above|below) line|remove lines? \d+|at the top of the file")


def diagnose_traceback(found: Traceback, trace: Trace) -> Cause:
    """Diagnose an exception, with the learner's own line; for a chain, the first known exception, else its origin."""
    if (cause := diagnose_known_exception(found, trace)) is not None:
        return cause
    own = found.origin.own(trace.folder) or found.own(trace.folder)
    return Cause(
        names.UNHANDLED_EXCEPTION,
        _describe(found.origin, found, trace),
        _unknown_exception_step(found.origin, own),
    )


def _unknown_exception_step(raised: Traceback, own: Frame | None) -> str:
    """The step for an unknown exception: the line at which Python stops, and its message."""
    message = raised.raised.rstrip(".")
    if own is None:
        return (
            f"look in the last lines of the output for the line of yours that leads to it, and change that: {message}"
        )
    return f"in line {own.line} of {own.name}, change what Python complains of there: {message}"


def diagnose_known_exception(found: Traceback, trace: Trace) -> Cause | None:
    """The cause of the first exception of a chain, from its origin on, that the table of known exceptions has.

    If the program handles the origin, and a call in its handler fails, from the last exception on.
    """
    chain = [found]
    while (before := chain[-1].follows) is not None:
        chain.append(before)
    if not _fails_in_handler(found, trace):
        chain.reverse()
    return next((cause for each in chain if (cause := _look_up(each, found, trace)) is not None), None)


def _fails_in_handler(found: Traceback, trace: Trace) -> bool:
    """Whether the exception comes from a statement of the learner's exception handler other than a `raise`."""
    own = found.own(trace.folder)
    if found.follows is None or own is None:
        return False
    file = SourceFile(trace.sources.get(own.name, ""))
    statement = file.statement_at(own.line)
    return (
        statement is not None
        and not isinstance(statement, ast.Raise)
        and any(isinstance(each, ast.ExceptHandler) for each in file.ancestors(statement))
    )


def _describe(each: Traceback, last: Traceback, trace: Trace) -> str:
    """The exception with the learner's line, and the last exception of the chain."""
    own = each.own(trace.folder) or last.own(trace.folder)
    return each.raised + (f" ({own})" if own else "") + _describe_last(each, last)


def _describe_last(each: Traceback, last: Traceback) -> str:
    return "" if each is last else f"; then {last.raised}"


def _look_up(each: Traceback, last: Traceback, trace: Trace) -> Cause | None:
    own = each.own(trace.folder) or last.own(trace.folder)
    file = own.name if own and own.name in trace.sources else trace.file
    seen = exceptions.RaisedException(each, trace.folder, own, file, trace.sources.get(file, ""))
    # An exception that the program itself raises because of another one says less than that other one, so entries for
    # any type only apply to the origin.
    table = [k for k in (*trace.exceptions, *exceptions.load_shipped()) if k.type != ".*" or each is last.origin]
    found = exceptions.explain(seen, table, cause=names.UNHANDLED_EXCEPTION, after=_describe_last(each, last))
    if found is None and each.type.endswith("InvalidParameterTypeException"):
        return parameters.diagnose_parameter_type(_describe(each, last, trace))
    if found is not None and each.type.endswith("NotInitializedException") and file != trace.file:
        return replace(found, hint=_initialise_before_import_time(trace, each) or found.hint)
    if found is not None and each.type.endswith("ParameterAlreadyDeclaredException") and own is not None:
        node = node_file(seen.source)
        found = replace(found, hint=node.step(declare_once(node, own.line)) or found.hint)
    if found is not None and each.type.endswith(_SYNTAX_ERRORS) and not is_applicable(found.hint, {file: seen.source}):
        found = replace(found, hint=make_readable(seen.source) or found.hint)
    if found is not None and len(trace.sources) > 1 and _EDITS.match(found.hint):
        return replace(found, hint=f"in {file}, {found.hint}")
    return found


def _initialise_before_import_time(trace: Trace, raised: Traceback) -> str | None:
    """The step that calls rclpy.init() above the line, outside of all functions, that creates the node."""
    started = node_file(trace.sources.get(trace.file, ""), trace.file)
    line = next((each.line for each in raised.frames if (each.name, each.function) == (trace.file, "<module>")), None)
    made = started.statement_at(line) if line is not None else None
    inits = [each for each in started.calls("init") if ast.unparse(each.func) == "rclpy.init"]
    if made is None or len(inits) != 1 or started.function_around(inits[0]) is None:
        return None
    removed = edits.remove_statement(started.text, started.statement(inits[0]))
    return started.step([edits.insert_above(made.lineno, "rclpy.init()"), removed])
