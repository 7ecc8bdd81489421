"""Callbacks that end the program or never return, as the learner's source shows: the cause, with the step."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from tutor.judge.causes import names
from tutor.judge.edits import Edit, remove_statement, replace_nodes, replace_statement
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.source import Function, called_name, calls_in, where
from tutor.judge.verdict import Cause

_SHUTDOWNS = "shutdown", "try_shutdown"
_EXITS = "exit", "_exit", "quit"


def diagnose_exit_in_callback(file: NodeFile, ended: str) -> Cause | None:
    """Whether the callback of a timer or subscription ends the program. `ended`: words on how it ended."""
    for function in _callbacks(file):
        for statement in (each for each in ast.walk(function) if isinstance(each, ast.stmt)):
            match statement:
                case ast.Raise(exc=ast.expr() as raised) if "SystemExit" in ast.unparse(raised):
                    edit = replace_statement(statement, "return")
                case ast.Expr(value=ast.Call() as call) if called_name(call) in _EXITS:
                    edit = replace_statement(statement, "return")
                case ast.Expr(value=ast.Call() as call) if called_name(call) in _SHUTDOWNS:
                    edit = remove_statement(file.text, statement)
                case _:
                    continue
            if (step := file.step([edit])) is not None:
                text = f"{ended}: line {statement.lineno}, {ast.unparse(statement)}, in {function.name}"
                return Cause(names.EXIT_AT_ONCE, text, step)
    return None


def diagnose_unused_group(file: NodeFile) -> Cause | None:
    """Whether a callback group is created for an executor with several threads, but no callback is in it."""
    timers = [each for each in file.timers if argument(each, 2, "callback_group") is None]
    if len(timers) < 2 or not file.calls("MultiThreadedExecutor"):
        return None
    for made in file.calls("ReentrantCallbackGroup", "MutuallyExclusiveCallbackGroup"):
        group = file.assigned_to(made)
        if not group.startswith("self.") or len(re.findall(rf"\b{re.escape(group[5:])}\b", file.text)) > 1:
            continue
        moved = timers if called_name(made) == "ReentrantCallbackGroup" else timers[:1]
        swaps = [(each, f"{ast.unparse(each)[:-1]}, callback_group={group})") for each in moved]
        step = file.step(replace_nodes(file.text, *swaps))
        text = (
            f"{where(made)} creates a callback group for several threads, but no callback is in it: all are in the "
            "node's own group, where each waits for the others"
        )
        return Cause("callback group not used", text, step) if step else None
    return None


def diagnose_loop_in_callback(file: NodeFile, program: Sequence[Edit]) -> Cause | None:
    """Whether a timer's callback sleeps in a loop of its own, so that it never returns. `program`: a rewritten one."""
    for function in _callbacks(file):
        for loop in (each for each in ast.walk(function) if isinstance(each, ast.While)):
            if calls_in(loop, "sleep", "wait") and (step := file.step(program)) is not None:
                text = (
                    f"line {loop.lineno}: {function.name} repeats by itself and does not return, and until it does, no "
                    "other callback runs; a timer repeats"
                )
                return Cause(names.BLOCKED_EXECUTOR, text, step)
    return None


def _callbacks(file: NodeFile) -> Iterator[Function]:
    """The functions that are reached from the callbacks of timers and subscriptions."""
    given = [argument(each, 1, "callback") for each in file.timers]
    given += [argument(each, 2, "callback") for each in file.calls("create_subscription")]
    for callback in given:
        if (function := file.function(callback)) is not None:
            yield from file.reachable_from(function)
