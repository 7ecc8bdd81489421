"""Slips in a timer's period that the learner's file shows by a line: the cause, with the edit of that line."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.edits import remove_statement, replace_node
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.source import values_of, where
from tutor.judge.verdict import Cause


def diagnose_integer_period(file: NodeFile) -> Cause | None:
    """Whether a timer's period is made a whole number: by //, int() or round()."""
    found = [(spot, right) for spot in _spots(file) if (right := _with_decimals(spot)) is not None]
    step = file.step([replace_node(file.text, spot, right) for spot, right in found])
    if not found or step is None:
        return None
    spot = found[0][0]
    text = f"line {spot.lineno}: {ast.unparse(spot)} has no decimals: 1 // 5 is 0, and int(1 / 0.7) is 1"
    return Cause("period made a whole number", text, step)


def diagnose_period_unit(file: NodeFile) -> Cause | None:
    """Whether a period is not 1 divided by a rate, but another number."""
    for spot in _spots(file):
        match spot:
            case ast.BinOp(left=ast.Constant(value=int() | float() as number) as top, op=ast.Div()) if number != 1:
                step = file.step([replace_node(file.text, top, "1.0")])
                text = (
                    f"line {spot.lineno}: the period {ast.unparse(spot)} is not the one of this rate: create_timer "
                    "takes seconds"
                )
                return Cause("wrong timer period", text, step) if step else None
    return None


def diagnose_sleep(file: NodeFile, asked_hz: float) -> Cause | None:
    """Whether the timer's callback, or what it calls, sleeps: the timer can be no faster than that.

    A nap of less than a tenth of the period, at `asked_hz`, hardly counts.
    """
    called = file.reached(file.tick) if file.tick is not None else []
    for call in file.calls("sleep"):
        match call.args:
            case [ast.Constant(value=int() | float() as nap_s)] if nap_s < 0.1 / asked_hz:
                continue
        if file.function_around(call) in called:
            step = file.step([remove_statement(file.text, file.statement(call))])
            text = f"{where(call)}: the timer's callback sleeps here, and meanwhile the timer stands still"
            return Cause("callback sleeps", text, step) if step else None
    return None


def _with_decimals(period: ast.expr) -> str | None:
    match period:
        case ast.BinOp(left=left, op=ast.FloorDiv(), right=right):
            return ast.unparse(ast.BinOp(left, ast.Div(), right))
        case ast.Call(func=ast.Name(id="int" | "round"), args=[inner]):
            return ast.unparse(inner)
    return None


def _spots(file: NodeFile) -> Iterator[ast.expr]:
    """Where the timers' periods are worked out."""
    for call in file.timers:
        given = argument(call, 0, "timer_period_sec")
        if given is not None:
            yield given
            yield from values_of(ast.unparse(given), file.tree)
