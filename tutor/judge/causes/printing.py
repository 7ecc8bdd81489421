"""What is printed, or given to Python's own logging: the line that does so, and what it becomes as a log message."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge import source
from tutor.judge.edits import replace_nodes
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.trace import Trace

_LEVELS = ("debug", "info", "warning", "warn", "error", "critical", "exception")


def find_print(trace: Trace, text: str) -> ast.Call | None:
    """The print() that wrote this text; None where this is not known."""
    found = [call for call in source.calls(trace, "print") if _wrote(call, text)]
    return max(found, key=lambda call: sum(map(len, _words(call))), default=None)


def python_logging(trace: Trace, text: str = "") -> ast.Call | None:
    """The call of Python's logging module that wrote this text, or the first one where there is none."""
    if "logging" not in {alias.name for file in source.files(trace) for _, alias in file.imports}:
        return None
    loggers = {name for name, _ in source.assigned(trace, "getLogger")} | {"logging"}
    calls = [
        call
        for call in source.calls(trace, *_LEVELS)
        if isinstance(call.func, ast.Attribute) and ast.unparse(call.func.value) in loggers and call.args
    ]
    if not text:
        return next(iter(calls), None)
    return next((call for call in calls if _wrote(call, text)), None)


def enable_rosout(file: NodeFile) -> str | None:
    """The step after which what the node logs reaches /rosout, where its file keeps that from it."""
    off = [
        (each.value, "True")
        for call in file.calls("__init__", "Node", "create_node")
        for each in call.keywords
        if each.arg == "enable_rosout"
    ]
    off += [
        (each, repr("--enable-rosout-logs"))
        for each in ast.walk(file.tree)
        if isinstance(each, ast.Constant) and each.value == "--disable-rosout-logs"
    ]
    return file.step(replace_nodes(file.text, *off))


def log_instead_of_print(trace: Trace, call: ast.Call) -> str:
    """The step: the line with the node's own logger in it."""
    function = source.file_holding(trace, call).function_around(call)
    mine = function is not None and [each.arg for each in function.args.args[:1]] == ["self"]
    level = source.called_name(call)
    level = {"print": "info", "critical": "fatal", "exception": "error", "debug": "info"}.get(level, level)
    line = f"line {call.lineno}" if call.end_lineno == call.lineno else f"lines {call.lineno} to {call.end_lineno}"
    verb = "becomes" if call.end_lineno == call.lineno else "become"
    return f"{line} {verb}: {'self' if mine else 'node'}.get_logger().{level}({_message(call)})"


def _message(call: ast.Call) -> str:
    """All arguments as one text."""
    if len(call.args) == 1:
        only = call.args[0]
        text = isinstance(only, ast.JoinedStr) or (isinstance(only, ast.Constant) and isinstance(only.value, str))
        return ast.unparse(only) if text or isinstance(only, ast.BinOp) else f"str({ast.unparse(only)})"
    if source.called_name(call) != "print":
        return f"{ast.unparse(call.args[0])} % {ast.unparse(ast.Tuple(call.args[1:]))}"
    parts: list[ast.expr] = []
    for each in call.args:
        if parts:
            parts.append(ast.Constant(" "))
        parts += each.values if isinstance(each, ast.JoinedStr) else [_part(each)]
    return ast.unparse(ast.JoinedStr(parts))


def _part(each: ast.expr) -> ast.expr:
    if isinstance(each, ast.Constant) and isinstance(each.value, str):
        return each
    return ast.FormattedValue(each, -1)


def _wrote(call: ast.Call, text: str) -> bool:
    words = _words(call)
    return bool(words) and all(word in text for word in words)


def _words(call: ast.Call) -> list[str]:
    """What is written as it stands, whatever the values are."""
    texts = [text for argument in call.args for text in _texts(argument)]
    pieces = [piece.strip() for text in texts for piece in re.split(r"%[-\d.]*[a-z]|\{[^}]*\}|\n", text)]
    return [piece for piece in pieces if piece]


def _texts(node: ast.AST) -> Iterator[str]:
    """The texts in an expression, but for those that are given to a call, or are a key."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.FormattedValue):
        yield from _texts(node.value)  # not its format, such as .2f
    elif not isinstance(node, ast.Call | ast.Subscript):
        for child in ast.iter_child_nodes(node):
            yield from _texts(child)
