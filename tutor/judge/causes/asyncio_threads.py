"""Mistakes in programs that run an asyncio event loop in one thread and an executor in another."""

from __future__ import annotations

import ast

from tutor.judge import edits, source
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.verdict import Cause

_WAKES = ("set", "set_result", "set_exception", "put_nowait")
_MADE_BY = ("Event", "Future", "create_future", "Queue")


def diagnose_other_threads_wake_up(file: NodeFile) -> Cause | None:
    """Whether a done callback of ROS sets an asyncio event or future, which does not wake its loop from that thread.

    Source: "Concurrency and Multithreading" in Python's documentation of asyncio.
    """
    for call in file.calls("add_done_callback"):
        match call.args:
            case [ast.Lambda(args=ast.arguments(args=[taken]), body=ast.Call() as wake) as given]:
                if not isinstance(wake.func, ast.Attribute) or wake.func.attr not in _WAKES:
                    continue
                if not any(map(_is_of_asyncio, source.values_of(ast.unparse(wake.func.value), file.tree))):
                    continue
                passed = ", ".join(map(ast.unparse, [wake.func, *wake.args]))
                becomes = f"lambda {taken.arg}, loop=asyncio.get_running_loop(): loop.call_soon_threadsafe({passed})"
                step = file.step([edits.replace_node(file.text, given, becomes)])
                text = (
                    f"{source.where(wake)} runs in the executor's thread: it does not wake the event loop of asyncio, "
                    "which goes on only when something else does"
                )
                return Cause("event loop not woken", text, step) if step else None
    return None


def _is_of_asyncio(value: ast.expr) -> bool:
    """Whether a value is made by asyncio, such as asyncio.Event() or loop.create_future()."""
    if not isinstance(value, ast.Call) or source.called_name(value) not in _MADE_BY:
        return False
    return source.called_name(value) == "create_future" or ast.unparse(value.func).startswith("asyncio.")
