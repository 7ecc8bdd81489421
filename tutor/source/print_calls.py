"""Find the lines that print, or use Python's own logging, by the text that they have written."""

from __future__ import annotations

import ast
import re

from tutor.source.file import Function, SourceFile, called_name, last_name, values_of
from tutor.source.program import Program

_VALUE = "\0"
_PLACEHOLDER = re.compile(r"%[-\d.]*[a-z]|\{[^}]*\}")
_LEVELS = ("debug", "info", "warning", "warn", "error", "critical", "exception")

Call = tuple[SourceFile, ast.Call]
"""A call, and the file that it is in."""


def find_print(program: Program, text: str) -> Call | None:
    """The call of print() or of a standard stream's write() that wrote this line; None if unknown."""
    calls = [(file, call) for file in program.files for call in file.calls("print", "write") if _is_print(call)]
    sized = [(size, call) for call in calls if (size := _matching_characters(call, text))]
    return max(sized, key=lambda pair: pair[0])[1] if sized else None


def _is_print(call: ast.Call) -> bool:
    return called_name(call) == "print" or ast.unparse(call.func).endswith(("stdout.write", "stderr.write"))


def find_python_logging(program: Program, text: str = "") -> Call | None:
    """The call of Python's logging module that wrote this text, or the first such call if no text is given."""
    if "logging" not in {alias.name for file in program.files for _, alias in file.imports}:
        return None
    loggers = {file.assigned_to(call) for file in program.files for call in file.calls("getLogger")} | {"logging"}
    calls = [
        (file, call)
        for file in program.files
        for call in file.calls(*_LEVELS)
        if isinstance(call.func, ast.Attribute) and call.args
        if ast.unparse(call.func.value) in loggers or last_name(getattr(call.func.value, "func", None)) == "getLogger"
    ]
    return next((call for call in calls if not text or _matching_characters(call, text)), None)


def _matching_characters(call: Call, text: str) -> int:
    """How many literal characters of one of the lines that a call writes are in `text`; 0 unless they all are."""
    function = call[0].function_around(call[1])
    sizes = [0]
    for line in " ".join(_template(given, function) for given in call[1].args).split("\n"):
        pieces = [piece.strip() for piece in line.split(_VALUE) if piece.strip()]
        if all(piece in text for piece in pieces):
            sizes.append(sum(map(len, pieces)))
    return max(sizes)


def _template(code: ast.expr, function: Function | None) -> str:
    """The text that an expression makes, with `_VALUE` for each part that is not literal."""
    match code:
        case ast.Constant(value=str(text)):
            return _PLACEHOLDER.sub(_VALUE, text)
        case ast.JoinedStr(values=values):
            return "".join(_template(value, function) for value in values)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _template(left, function) + _template(right, function)
        case ast.BinOp(left=left, op=ast.Mod()):
            return _template(left, function)
        case ast.Call(func=ast.Attribute(value=template, attr="format")):
            return _template(template, function)
        case ast.Name(id=name) if function is not None and len(values := values_of(name, function)) == 1:
            return _template(values[0], None)  # no further: it may be made from itself
    return _VALUE
