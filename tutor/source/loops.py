"""Loops in a learner's functions, and whether they do anything but wait."""

from __future__ import annotations

import ast

from tutor.source.file import SourceFile, called_name

Loop = ast.While | ast.For

_WAITS = ("sleep", "wait")


def outermost_loop(file: SourceFile, line: int) -> Loop | None:
    """The outermost loop around a line, within the line's function."""
    found = [node for node in file.nodes if isinstance(node, Loop) and node.lineno <= line <= (node.end_lineno or 0)]
    return min(
        (loop for loop in found if file.function_around(loop) is file.function_at(line)),
        key=lambda loop: loop.lineno,
        default=None,
    )


def only_waits(statement: ast.stmt) -> bool:
    """Whether a statement does nothing, or only waits."""
    if isinstance(statement, ast.Pass | ast.Continue):
        return True
    return isinstance(statement, ast.Expr) and (
        isinstance(statement.value, ast.Constant)
        or (isinstance(statement.value, ast.Call) and called_name(statement.value) in _WAITS)
    )
