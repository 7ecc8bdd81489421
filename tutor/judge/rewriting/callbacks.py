"""Rewrite callbacks that block their node: await instead of waiting, leave repetition to a timer, hold no lock."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Sequence

from tutor.judge.edits import Edit, remove_lines, replace_lines, replace_node, replace_pattern, replace_statement
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.source import called_name

WITH_CALLBACK_GROUP = ("create_client", "create_service", "create_timer", "create_subscription")
_GROUP = "callback_group"
_WAITS = ("sleep", "wait")

Loop = ast.While | ast.For


def await_lines(file: NodeFile, line: int, code: str, last: int = 0) -> list[Edit]:
    """Replace a line, or the lines up to `last`, by code that awaits.

    Its function becomes a coroutine, and every callback gets a reentrant group.
    """
    function = file.function_at(line)
    if function is None:
        return []
    edits = [replace_lines(line, code, last)]
    if isinstance(function, ast.FunctionDef):
        head = file.text.splitlines()[function.lineno - 1].strip()
        edits.append(replace_lines(function.lineno, f"async {head}"))
    return [*edits, *make_reentrant(file)]


def make_reentrant(file: NodeFile) -> list[Edit]:
    """Put every callback into a reentrant group, where it may run concurrently with others."""
    name, imported = file.import_name("ReentrantCallbackGroup", "rclpy.callback_groups")
    exclusive = file.calls("MutuallyExclusiveCallbackGroup")
    edits = [replace_node(file.text, each, f"{name}()") for each in exclusive]
    for each in file.calls(*WITH_CALLBACK_GROUP):
        if any(given.arg in (_GROUP, None) for given in each.keywords) or not isinstance(each.func, ast.Attribute):
            continue
        edits.append(replace_node(file.text, each, f"{ast.unparse(each)[:-1]}, {_GROUP}={name}())"))
    return [*imported, *edits] if edits else []


def remove_lock(file: NodeFile, line: int) -> list[Edit]:
    """Replace the innermost `with` statement around a line, which holds a lock, by its body.

    Where there is none, remove the decorator whose function holds one while it calls the decorated function.
    """
    around = [
        each
        for each in ast.walk(file.tree)
        if isinstance(each, ast.With) and each.lineno <= line <= (each.end_lineno or 0)
    ]
    if around:
        innermost = max(around, key=lambda each: each.lineno)
        return [replace_statement(innermost, _code(file, innermost.body))]
    function = file.function_at(line)
    for decorator in function.decorator_list if function is not None else ():
        made = file.function(decorator)
        if made is not None and any(isinstance(each, ast.With) for each in ast.walk(made)):
            return [remove_lines(file.text, decorator.lineno, decorator.end_lineno or 0)]
    return []


def make_lock_reentrant(file: NodeFile) -> list[Edit]:
    """Turn each lock into one that a thread may acquire twice."""
    return replace_pattern(file.text, r"\bLock\b", "RLock")


def remove_loop(file: NodeFile, line: int) -> list[Edit]:
    """Replace the outermost loop around a line by one iteration; if there is no loop, remove the line."""
    loop = outermost(file, line)
    if loop is None:
        return [remove_lines(file.text, line)]
    work = [each for each in loop.body if not only_waits(each)]
    first, last = loop.lineno, loop.end_lineno or loop.lineno
    return [Edit(first, last, _code(file, work), like=first)] if work else [remove_lines(file.text, first, last)]


def outermost(file: NodeFile, line: int) -> Loop | None:
    """The outermost loop around a line, within the line's function."""
    found = [
        each for each in ast.walk(file.tree) if isinstance(each, Loop) and each.lineno <= line <= (each.end_lineno or 0)
    ]
    return min(
        (each for each in found if file.function_around(each) is file.function_at(line)),
        key=lambda each: each.lineno,
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


def _code(file: NodeFile, body: Sequence[ast.stmt]) -> str:
    """The code of a loop's or with statement's body, to be run outside of it."""
    lines = file.text.splitlines()
    found = [textwrap.dedent("\n".join(lines[each.lineno - 1 : each.end_lineno])) for each in body]
    code = "\n".join(found)
    return re.sub(r"\bcontinue\b", "return", code) if re.search(r"^\s*continue\b", code, re.MULTILINE) else code
