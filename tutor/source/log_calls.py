"""Whether a node's log messages all come early, so that there is no point in waiting for others.

This never decides what counts as logged. It only tells when a node has shown all that it will ever log by itself.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping

from tutor.source.file import calls_in, last_name
from tutor.source.node import NodeFile, node_file

_UNPREDICTABLE_MODULES = frozenset({"logging", "loguru", "asyncio", "threading", "time", "datetime"})
_UNPREDICTABLE_CALLS = ("exec", "eval", "getattr", "setattr", "__import__", "import_module", "get_clock")
_UNUSUAL_CALLS = ("sleep", "create_rate", "wait", "parse_args", "parse_known_args", "Thread", "Timer", "partial")
_BRANCHES = (ast.If, ast.IfExp, ast.Match, ast.For, ast.While, ast.Return, ast.Try, ast.BoolOp)


def logs_the_same_on_each_message(sources: Mapping[str, str]) -> bool:
    """Whether the node logs at the start, the same kind of messages each time it publishes, and nothing else.

    That is certain only of a node of the usual structure, in one file, with one timer, whose callback has no branches.
    """
    file = node_file(next(iter(sources.values()))) if len(sources) == 1 else node_file("")
    modules = {alias.name.split(".")[0] for _, alias in file.imports}
    if not _is_usual(file) or len(file.timers) != 1:
        return False
    if modules & _UNPREDICTABLE_MODULES or file.calls(*_UNPREDICTABLE_CALLS):
        return False
    if any(isinstance(node, ast.AsyncFunctionDef | ast.Lambda) for node in file.nodes):
        return False
    names = [node for node in file.nodes if last_name(node) == "get_logger"]
    return all(_is_early(file, name) for name in names)


def _is_usual(file: NodeFile) -> bool:
    """Whether a node has the usual structure: one class, its timer kept in an attribute, its callbacks methods."""
    setup, timer, tick = file.setup, file.first_timer, file.timer_callback
    owner = file.class_of(setup) if setup is not None else None
    if owner is None or timer is None or tick is None or tick is setup or file.class_of(tick) is not owner:
        return False
    has_loop = any(isinstance(node, ast.While) for node in file.nodes)
    return (
        file.node == "self"
        and not has_loop
        and re.fullmatch(r"self\.\w+", file.assigned_to(timer)) is not None
        and len([node for node in file.tree.body if isinstance(node, ast.ClassDef)]) == 1
        and not file.calls(*_UNUSUAL_CALLS)
    )


def _is_early(file: NodeFile, name: ast.AST) -> bool:
    """Whether a log call comes on each message, at the start, or around the spin: before it or at the end."""
    function = file.function_around(name)
    logs = next((ancestor for ancestor in file.ancestors(name) if isinstance(ancestor, ast.Expr)), None)
    call = logs.value if logs is not None else None
    match call:
        case ast.Call(func=ast.Attribute(value=ast.Call(func=logger)), keywords=given) if logger is name and function:
            if function is file.timer_callback:
                return not given and not any(isinstance(node, _BRANCHES) for node in ast.walk(function))
            return function is file.setup or bool(calls_in(function, "spin"))
    return False  # such as a logger that is kept in a variable
