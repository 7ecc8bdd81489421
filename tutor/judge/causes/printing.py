"""Find the lines that print, or use Python's own logging, and rewrite them to use the node's logger."""

from __future__ import annotations

import ast
import re

from tutor.judge import source
from tutor.judge.edits import describe_edits_of, replace_nodes, replace_pattern, replace_statement
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_VALUE = "\0"
_PLACEHOLDER = re.compile(r"%[-\d.]*[a-z]|\{[^}]*\}")

_METHODS = {"print": "info", "write": "info", "critical": "fatal", "exception": "error", "debug": "info"}
"""The method of a node's logger that replaces a function or method, where it has another name."""

_LEVELS = ("debug", "info", "warning", "warn", "error", "critical", "exception")


def find_print(trace: Trace, text: str) -> ast.Call | None:
    """The call of print() or of a standard stream's write() that wrote this line; None if unknown."""
    calls = [call for call in source.calls(trace, "print", "write") if _is_print(call)]
    found = [(size, call) for call in calls if (size := _matching_characters(trace, call, text))]
    return max(found, key=lambda each: each[0], default=(0, None))[1]


def _is_print(call: ast.Call) -> bool:
    return source.called_name(call) == "print" or ast.unparse(call.func).endswith(("stdout.write", "stderr.write"))


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
    return next((call for call in calls if _matching_characters(trace, call, text)), None)


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


def use_node_logger(file: NodeFile) -> str | None:
    """The step that replaces loggers that belong to no node by the node's own, in methods of the node's class."""
    made = [call for call in file.calls("get_logger") if call.args or call.keywords]
    names = {file.assigned_to(call) for call in made if file.function_around(call) is None}
    uses = [each for each in file.nodes if isinstance(each, ast.Name) and each.id in names]
    swaps = [
        (each, f"{method.args.args[0].arg}.get_logger()")
        for each in (*made, *uses)
        if (method := file.node_method(each)) is not None and method.args.args
    ]
    return file.step(replace_nodes(file.text, *swaps))


def diagnose_own_logger(file: NodeFile) -> Cause | None:
    """Whether the file sets the attribute in which rclpy's Node keeps its logger to one of Python's own."""
    for node in file.nodes:
        match node:
            case ast.Assign(targets=[ast.Attribute(value=ast.Name(id="self"), attr="_logger")], value=value) if (
                ast.unparse(value).startswith("logging.")
            ):
                step = file.step(replace_pattern(file.text, r"\bself\._logger\b", "self._python_logger"))
                text = (
                    f"line {node.lineno}: {ast.unparse(node)} replaces the logger that rclpy keeps under this name: "
                    "what get_logger() returns then knows nothing of ROS"
                )
                return Cause("node's logger replaced", text, step) if step else None
    return None


def log_instead_of_print(trace: Trace, call: ast.Call) -> str:
    """The step that replaces a call by one of the node's own logger, and with it the calls right above and below it."""
    file = source.file_holding(trace, call)
    together = [each for each in _neighbours(file, call) if source.called_name(each[1]) == "print" and each[1].args]
    edits = [replace_statement(statement, _log_code(file, each)) for statement, each in reversed(together)]
    if len(edits) > 1 and (step := describe_edits_of(file, *edits)) is not None:
        return step
    line = f"line {call.lineno}" if call.end_lineno == call.lineno else f"lines {call.lineno} to {call.end_lineno}"
    verb = "becomes" if call.end_lineno == call.lineno else "become"
    return f"{line} {verb}: {_log_code(file, call)}"


def _neighbours(file: source.SourceFile, call: ast.Call) -> list[tuple[ast.stmt, ast.Call]]:
    """The uninterrupted series of statements around this call that are nothing but calls, with these calls."""
    statement = file.statement(call)
    series: list[tuple[ast.stmt, ast.Call]] = []
    for each in file.block_of(statement) or [statement]:
        if isinstance(each, ast.Expr) and isinstance(each.value, ast.Call):
            series.append((each, each.value))
        elif any(found is statement for found, _ in series):
            break
        else:
            series = []
    return series


def _log_code(file: source.SourceFile, call: ast.Call) -> str:
    function = file.function_around(call)
    is_method = function is not None and [each.arg for each in function.args.args[:1]] == ["self"]
    name = source.called_name(call)
    return f"{'self' if is_method else 'node'}.get_logger().{_METHODS.get(name, name)}({_message(call)})"


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


def _matching_characters(trace: Trace, call: ast.Call, text: str) -> int:
    """How many literal characters of one of the lines that a call writes are in `text`; 0 unless they all are."""
    function = source.file_holding(trace, call).function_around(call)
    sizes = [0]
    for line in " ".join(_template(each, function) for each in call.args).split("\n"):
        pieces = [piece.strip() for piece in line.split(_VALUE) if piece.strip()]
        if all(piece in text for piece in pieces):
            sizes.append(sum(map(len, pieces)))
    return max(sizes)


def _template(code: ast.expr, function: source.Function | None) -> str:
    """The text that an expression makes, with `_VALUE` for each part that is not literal."""
    match code:
        case ast.Constant(value=str(text)):
            return _PLACEHOLDER.sub(_VALUE, text)
        case ast.JoinedStr(values=values):
            return "".join(_template(each, function) for each in values)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _template(left, function) + _template(right, function)
        case ast.BinOp(left=left, op=ast.Mod()):
            return _template(left, function)
        case ast.Call(func=ast.Attribute(value=template, attr="format")):
            return _template(template, function)
        case ast.Name(id=name) if function is not None and len(values := source.values_of(name, function)) == 1:
            return _template(values[0], None)  # no further: it may be made from itself
    return _VALUE
