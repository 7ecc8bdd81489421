"""I1.2: the next step of each criterion, as edits of the learner's own file; None where there is none to be sure of."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from checks.i1_2 import rewriting
from checks.i1_2.listener import find
from checks.i1_2.templates import logged
from tutor.judge import source
from tutor.judge.edits import removed
from tutor.judge.trace import Trace

_GAPS = """\
number = int({content}.rpartition(':')[2])
if {last} is not None and number > {last} + 1:
    {logger}.warning(f'{{number - {last} - 1}} messages are missing before {{number}}')
{last} = number"""


def count(trace: Trace) -> str | None:
    """States the true total."""
    return rewriting.whole(trace)


def rate(trace: Trace) -> str | None:
    """States messages per second."""
    return rewriting.whole(trace)


def summary(trace: Trace) -> str | None:
    """Sums up every ten messages, with the first and the last one."""
    return rewriting.whole(trace)


def first_kept(trace: Trace) -> str | None:
    """Leaves the first message alone once it is there."""
    listener = find(trace)
    for function in source.callbacks(trace, "create_subscription"):
        for node in ast.walk(function):
            match node:
                case ast.Assign(targets=[target], value=ast.Constant(value=None | "")) if "first" in ast.unparse(
                    target
                ):
                    if listener and (step := rewriting.step(trace, listener, [removed(listener.text, node.lineno)])):
                        return step
    return rewriting.whole(trace)


def restart(trace: Trace) -> str | None:
    """Goes on when the publisher was restarted."""
    return rewriting.whole(trace)


def silent(trace: Trace) -> str | None:
    """Says that the publisher was restarted."""
    return rewriting.whole(trace)


def gaps(trace: Trace, false: Sequence[str] = ()) -> str | None:
    """Compares each number with the one before; `false`: log messages of gaps that there were not, to be taken out."""
    listener = find(trace)
    if listener is None or not (listener.message and listener.logger):
        return rewriting.whole(trace)
    last = listener.new("last_number", "number_before")
    code = _GAPS.format(content=listener.content, logger=listener.logger, last=last)
    told = [logged(trace, each) for each in false[-1:]]
    if all(each is not None and each.text == listener.text for each in told):
        edits = [
            rewriting.first_value(listener, [f"{last} = None"]),
            rewriting.on_entry(listener, [last], code),
            *(removed(each.text, each.statement.lineno, each.statement.end_lineno or 0) for each in told if each),
        ]
        if step := rewriting.step(trace, listener, edits):
            return step
    return rewriting.whole(trace)
