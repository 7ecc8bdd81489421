"""Find the lines that print, or use Python's own logging, and rewrite them to use the node's logger."""

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
    """The print() call that wrote this text; None if unknown."""
    found = [call for call in source.calls(trace, "print") if _may_have_written(call, text)]
    return max(found, key=lambda call: sum(map(len, _literal_pieces(call))), default=None)


def find_python_logging(trace: Trace, text: str = "") -> ast.Call | None:
    """The call of Python's logging module that wrote this text, or the first such call if no text is given."""
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
    return next((call for call in calls if _may_have_written(call, text)), None)


def enable_rosout(file: NodeFile) -> str | None:
    """The step that lets the node's log messages reach /rosout, if its file switches that off."""
    swaps = [
        (each.value, "True")
        for call in file.calls("__init__", "Node", "create_node")
        for each in call.keywords
        if each.arg == "enable_rosout"
    ]
    swaps += [
        (each, repr("--enable-rosout-logs"))
        for each in ast.walk(file.tree)
        if isinstance(each, ast.Constant) and each.value == "--disable-rosout-logs"
    ]
    return file.step(replace_nodes(file.text, *swaps))


def log_instead_of_print(trace: Trace, call: ast.Call) -> str:
    """The step that replaces a call by one of the node's own logger."""
    function = source.file_holding(trace, call).function_around(call)
    is_method = function is not None and [each.arg for each in function.args.args[:1]] == ["self"]
    level = source.called_name(call)
    level = {"print": "info", "critical": "fatal", "exception": "error", "debug": "info"}.get(level, level)
    line = f"line {call.lineno}" if call.end_lineno == call.lineno else f"lines {call.lineno} to {call.end_lineno}"
    verb = "becomes" if call.end_lineno == call.lineno else "become"
    return f"{line} {verb}: {'self' if is_method else 'node'}.get_logger().{level}({_message(call)})"


def _message(call: ast.Call) -> str:
    """The code of one expression that joins all arguments into the text of a log message."""
    if len(call.args) == 1:
        only = call.args[0]
        is_text = isinstance(only, ast.JoinedStr) or (isinstance(only, ast.Constant) and isinstance(only.value, str))
        return ast.unparse(only) if is_text or isinstance(only, ast.BinOp) else f"str({ast.unparse(only)})"
    if source.called_name(call) != "print":
        return f"{ast.unparse(call.args[0])} % {ast.unparse(ast.Tuple(call.args[1:]))}"
    parts: list[ast.expr] = []
    for each in call.args:
        if parts:
            parts.append(ast.Constant(" "))
        parts += each.values if isinstance(each, ast.JoinedStr) else [_format_part(each)]
    return ast.unparse(ast.JoinedStr(parts))


def _format_part(argument: ast.expr) -> ast.expr:
    if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
        return argument
    return ast.FormattedValue(argument, -1)


def _may_have_written(call: ast.Call, text: str) -> bool:
    pieces = _literal_pieces(call)
    return bool(pieces) and all(piece in text for piece in pieces)


def _literal_pieces(call: ast.Call) -> list[str]:
    """The pieces of text that a call writes literally, whatever its values are."""
    texts = [text for argument in call.args for text in _texts(argument)]
    pieces = [piece.strip() for text in texts for piece in re.split(r"%[-\d.]*[a-z]|\{[^}]*\}|\n", text)]
    return [piece for piece in pieces if piece]


def _texts(node: ast.AST) -> Iterator[str]:
    """The string literals in an expression, except arguments of nested calls and subscripts."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.FormattedValue):
        yield from _texts(node.value)  # not its format, such as .2f
    elif not isinstance(node, ast.Call | ast.Subscript):
        for child in ast.iter_child_nodes(node):
            yield from _texts(child)
