"""I1.2: why a node does not keep up with its messages, with lines of its source."""

from __future__ import annotations

import ast

from checks.i1_2 import rewriting
from checks.i1_2.backlog import LostMessages
from tutor.judge import edits, source
from tutor.judge.causes.spinning import SPINS_ONCE
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


def diagnose_lost(trace: Trace, lost: LostMessages) -> Cause:
    """Why messages are lost at a high rate."""
    counted = f"up to the last message that it quotes there were {lost.counted}"
    text = f"{counted}: the others never reached its callback"
    if (waits := diagnose_waits(trace, text)) is not None:
        return waits
    if (depth := _find_short_queue(trace)) is not None:
        file = source.file_holding(trace, depth)
        return Cause(
            "queue too short",
            f"{text}, since its queue (line {depth.lineno}) holds one message only",
            edits.describe_edits_of(file, edits.replace_node(file.text, depth, "10"))
            or "give create_subscription a queue depth of 10",
        )
    return Cause(
        "cannot keep up",
        f"{counted}: it drops the others, or they never reach its callback, since the queue is full",
        rewriting.rewrite_callback(trace)
        or "let rclpy.spin(node) wait for the messages, and do nothing in the callback that takes long",
    )


def diagnose_waits(trace: Trace, text: str) -> Cause | None:
    """Find where the source waits while messages arrive. `text`: the observed consequence."""
    loops = [loop for loop in source.all_nodes(trace) if isinstance(loop, ast.While | ast.For)]
    for loop in loops:
        if source.calls_in(loop, *SPINS_ONCE):
            for nap in source.calls_in(loop, "sleep"):
                return Cause(
                    "nap between messages",
                    f"{text}, since the loop sleeps between one message and the next: line {nap.lineno}: "
                    f"{ast.unparse(nap)}",
                    _replace_by_spin(trace, loop)
                    or remove_call(trace, nap)
                    or f"take {ast.unparse(nap)} in line {nap.lineno} out: spin_once() waits by itself for the next "
                    "message. Or write rclpy.spin(node) instead of the loop",
                )
    for function in source.callbacks(trace, "create_subscription"):
        # A sleep inside a loop that waits for something is not the cause of the delay.
        waiting = {
            nap for loop in ast.walk(function) if isinstance(loop, ast.While) for nap in source.calls_in(loop, "sleep")
        }
        for nap in (nap for nap in source.calls_in(function, "sleep") if nap not in waiting):
            return Cause(
                "slow callback",
                f"{text}, since its callback sleeps: line {nap.lineno}: {ast.unparse(nap)}",
                remove_call(trace, nap)
                or f"take {ast.unparse(nap)} in line {nap.lineno} out: while a callback runs, no other message comes",
            )
    return None


def remove_call(trace: Trace, call: ast.Call) -> str | None:
    """The step that removes this call's statement; None if the call is only a part of it.

    An awaited sleep lets other coroutines run, so it is only made as short as possible.
    """
    file = source.file_holding(trace, call)
    made = file.statement(call)
    if isinstance(made, ast.Expr) and isinstance(made.value, ast.Await) and made.value.value is call and call.args:
        return edits.describe_edits_of(file, edits.replace_node(file.text, call.args[0], "0"))
    whole = isinstance(made, ast.Expr | ast.Assign) and made.value is call
    return edits.describe_edits_of(file, edits.remove_statement(file.text, made)) if whole else None


def _replace_by_spin(trace: Trace, loop: ast.While | ast.For) -> str | None:
    """The step that replaces a loop of nothing but spin_once() and sleep by spin()."""
    spins = source.calls_in(loop, *SPINS_ONCE)
    plain = all(isinstance(each, ast.Expr) and isinstance(each.value, ast.Call) for each in loop.body)
    if not plain or len(loop.body) > 2 or len(spins) != 1 or not isinstance(spins[0].func, ast.Attribute):
        return None
    code = f"{ast.unparse(spins[0].func.value)}.spin({', '.join(map(ast.unparse, spins[0].args[:1]))})"
    return edits.describe_edits_of(source.file_holding(trace, loop), edits.replace_statement(loop, code))


def _find_short_queue(trace: Trace) -> ast.Constant | None:
    """The depth of 1 that is given to the subscription."""
    for call in source.calls(trace, "create_subscription"):
        given = [*call.args[3:4], *(each.value for each in call.keywords if each.arg == "qos_profile")]
        for depth in given:
            if isinstance(depth, ast.Constant) and depth.value == 1:
                return depth
    return None
