"""I1.2: find the call in a learner's file that logged a message, and the expression behind each of its values."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tutor.judge import source
from tutor.judge.trace import Trace

_LEVELS = ("debug", "info", "warn", "warning", "error", "fatal")
_PERCENT_PLACEHOLDER = re.compile(r"%%|%\([^)]*\)[^a-zA-Z]*[a-zA-Z]|%[-+ #0-9.*]*[a-zA-Z]")
_FORMAT_PLACEHOLDER = re.compile(r"\{\{|\}\}|\{[^{}]*\}")

Part = str | ast.expr


@dataclass(frozen=True, slots=True)
class LogCall:
    """A logging call. `values`: each expression in its text, with its value; `function`: the enclosing function."""

    text: str
    call: ast.Call
    statement: ast.stmt
    function: source.Function | None
    values: tuple[tuple[ast.expr, str], ...]


def find_log_call(trace: Trace, message: str) -> LogCall | None:
    """Find the call that logged this message; None if it is unknown."""
    for file in source.files(trace):
        for call in (each for each in file.nodes if isinstance(each, ast.Call) and source.called_name(each) in _LEVELS):
            function = file.function_around(call)
            if call.args and (values := match_template(call.args[0], message, function)) is not None:
                return LogCall(file.text, call, file.statement(call), function, tuple(values))
    return None


def match_template(
    written: ast.expr, message: str, function: ast.AST | None = None
) -> list[tuple[ast.expr, str]] | None:
    """Each expression in a composed string, with its value in `message`; None if the message does not match."""
    parts = list(_parts(written, function))
    if not any(isinstance(each, str) and each.strip() for each in parts):
        return None
    expressions = [each for each in parts if not isinstance(each, str)]
    between = [""]
    for each in parts:
        if isinstance(each, str):
            between[-1] += each
        else:
            between.append("")
    found = match_literals(between, message)
    return list(zip(expressions, found, strict=True)) if found is not None else None


def match_literals(between: Sequence[str], message: str) -> list[str] | None:
    """The shortest parts of a message between these texts; None if the message does not consist of them."""
    first, *others = between
    if not message.startswith(first):
        return None
    found, end = [], len(first)
    for number, text in enumerate(others, 1):
        last = number == len(others)
        at = max(len(message) - len(text), end) if last else message.find(text, end)
        if at < 0 or not message.startswith(text, at):
            return None
        found.append(message[end:at])
        end = at + len(text)
    return found if end == len(message) else None


def _parts(node: ast.expr, function: ast.AST | None, depth: int = 0) -> Iterator[Part]:
    """The parts of a composed string: literal text, and expressions."""
    match node:
        case ast.Constant(value=str() as plain):
            yield plain
        case ast.JoinedStr(values=values):
            for each in values:
                inner = each.value if isinstance(each, ast.FormattedValue) else each
                yield from [inner] if isinstance(each, ast.FormattedValue) else _parts(inner, function, depth)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            yield from _parts(left, function, depth)
            yield from _parts(right, function, depth)
        case ast.BinOp(left=ast.Constant(value=str() as plain), op=ast.Mod(), right=given):
            yield from _format_parts(
                _PERCENT_PLACEHOLDER, plain, given.elts if isinstance(given, ast.Tuple) else [given]
            )
        case ast.Call(func=ast.Attribute(value=ast.Constant(value=str() as plain), attr="format"), args=given):
            yield from _format_parts(_FORMAT_PLACEHOLDER, plain, given)
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            yield inner
        case ast.Name(id=name) if function is not None and depth < 3:
            given = source.values_of(name, function)
            yield from _parts(given[0], function, depth + 1) if len(given) == 1 else [node]
        case _:
            yield node


def _format_parts(placeholders: re.Pattern[str], plain: str, given: Sequence[ast.expr]) -> Iterator[Part]:
    """The parts of a format string: literal text, and the arguments for its placeholders."""
    remaining, end = list(given), 0
    for found in placeholders.finditer(plain):
        yield plain[end : found.start()]
        end = found.end()
        if found[0] in ("%%", "{{", "}}"):
            yield found[0][0]
        else:
            yield remaining.pop(0) if remaining else ast.Constant(None)
    yield plain[end:]
