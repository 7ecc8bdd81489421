"""I1.2: why a node does not keep up with its messages, in the words of its source."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2.backlog import Lost
from tutor.judge import source
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

SPINS_ONCE = ("spin_once", "spin_some")


def of_lost(trace: Trace, lost: Lost) -> Cause:
    """Why messages that come fast are lost."""
    text = f"up to the last message that it quotes there were {lost.counted}: the others never reached its callback"
    if (waits := of_waits(trace, text)) is not None:
        return waits
    if (short := _short_queue(trace)) is not None:
        return Cause(
            "queue too short",
            f"{text}, since its queue (line {short.lineno}) holds one message only",
            "give create_subscription a queue depth of 10",
        )
    return Cause(
        "cannot keep up",
        f"{text}, since the queue was full",
        "let rclpy.spin(node) wait for the messages, and do nothing in the callback that takes long",
    )


def of_waits(trace: Trace, text: str) -> Cause | None:
    """Where its source makes it wait while messages come; `text` says what follows from it."""
    loops = [loop for loop in source.nodes(trace) if isinstance(loop, ast.While | ast.For)]
    for loop in loops:
        if any(source.called(call) in SPINS_ONCE for call in _calls(loop)):
            for nap in _naps(loop):
                return Cause(
                    "nap between messages",
                    f"{text}, since the loop sleeps between one message and the next: line {nap.lineno}: "
                    f"{ast.unparse(nap)}",
                    f"take {ast.unparse(nap)} in line {nap.lineno} out: spin_once() waits by itself for the next "
                    "message. Or write rclpy.spin(node) instead of the loop",
                )
    for function in source.callbacks(trace, "create_subscription"):
        # In a loop that waits for something, it is not the nap that keeps it.
        waiting = {nap for loop in ast.walk(function) if isinstance(loop, ast.While) for nap in _naps(loop)}
        for nap in (nap for nap in _naps(function) if nap not in waiting):
            return Cause(
                "slow callback",
                f"{text}, since its callback sleeps: line {nap.lineno}: {ast.unparse(nap)}",
                f"take {ast.unparse(nap)} in line {nap.lineno} out: while a callback runs, no other message comes in",
            )
    return None


def _short_queue(trace: Trace) -> ast.Call | None:
    for call in source.calls(trace, "create_subscription"):
        given = [*call.args[3:4], *(each.value for each in call.keywords if each.arg == "qos_profile")]
        if any(isinstance(depth, ast.Constant) and depth.value == 1 for depth in given):
            return call
    return None


def _naps(inside: ast.AST) -> Iterator[ast.Call]:
    return (call for call in _calls(inside) if source.called(call) == "sleep")


def _calls(inside: ast.AST) -> Iterator[ast.Call]:
    return (node for node in ast.walk(inside) if isinstance(node, ast.Call))
