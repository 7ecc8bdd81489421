"""I1.2: evaluate a learner's expression for a message's text without running any of their code."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass

from tutor.source import Function, values_of

EXAMPLES = ("Hello World: 107", "Hello World: 38", "Hello World: 4")

_METHODS = frozenset(
    {"split", "rsplit", "partition", "rpartition", "strip", "lstrip", "rstrip", "replace", "removeprefix", "lower"}
)
_MAX_DEPTH = 12


class _Unknown(Exception):
    """The expression cannot be evaluated."""


@dataclass(frozen=True, slots=True)
class _Evaluator:
    """Evaluates expressions of one function, with `text` as the message's text."""

    function: Function
    text: str

    def value(self, node: ast.expr, depth: int = 0) -> object:
        """Evaluate an expression. Raises _Unknown, or the exception that Python would raise."""
        if depth > _MAX_DEPTH:
            raise _Unknown
        match node:
            case ast.Constant(value=str() | int() as plain):
                return plain
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() as plain)):
                return -plain
            case ast.Attribute(attr="data"):
                return self.text
            case ast.Name(id=name):
                return self._variable(name, depth)
            case ast.Subscript(value=inner, slice=ast.Slice(lower=lower, upper=upper, step=None)):
                whole = self.value(inner, depth + 1)
                if isinstance(whole, str | list | tuple):
                    return whole[self._bound(lower, depth) : self._bound(upper, depth)]
            case ast.Subscript(value=inner, slice=index):
                whole, at = self.value(inner, depth + 1), self.value(index, depth + 1)
                if isinstance(whole, str | list | tuple) and isinstance(at, int):
                    return whole[at]
            case ast.Call(func=ast.Attribute(value=inner, attr=name), args=given, keywords=[]) if name in _METHODS:
                whole = self.value(inner, depth + 1)
                if isinstance(whole, str):
                    return getattr(whole, name)(*(self.value(argument, depth + 1) for argument in given))
            case ast.Call(func=ast.Name(id="int"), args=[inner], keywords=[]):
                read = self.value(inner, depth + 1)
                if isinstance(read, str | int):
                    return int(read)
        raise _Unknown

    def _bound(self, node: ast.expr | None, depth: int) -> int | None:
        """Evaluate one bound of a slice."""
        at = None if node is None else self.value(node, depth + 1)
        if at is None or isinstance(at, int):
            return at
        raise _Unknown

    def _variable(self, name: str, depth: int) -> object:
        given = values_of(name, self.function)
        if len(given) == 1:
            return self.value(given[0], depth + 1)
        if not given and name in {parameter.arg for parameter in self.function.args.args}:
            return self.text
        raise _Unknown


@dataclass(frozen=True, slots=True)
class Misread:
    """An expression that takes the number from the wrong place. `text`: what it reads."""

    node: ast.Call
    text: str


def find_misread(functions: Sequence[Function]) -> Misread | None:
    """Find an expression that takes the number from the wrong place of the text."""
    for function in functions:
        for node in ast.walk(function):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "int" and node.args:
                for text in EXAMPLES:
                    if (found := _check_example(function, node, text)) is not None:
                        return found
    return None


def _check_example(function: Function, node: ast.Call, text: str) -> Misread | None:
    base = _find_text_expression(function, node)
    if base is None:
        return None
    evaluator, right = _Evaluator(function, text), int(text.rpartition(":")[2])
    try:
        read = evaluator.value(node)
    except (ValueError, IndexError, TypeError):
        reads = "no number out of"
    except _Unknown:
        return None
    else:
        if read == right:
            return None
        reads = f"{read!r} out of"
    description = f"{ast.unparse(node)} reads {reads} “{text}”"
    return Misread(node, description)


def _find_text_expression(function: Function, node: ast.expr, depth: int = 0) -> str | None:
    """The part of the expression with the message's text: msg.data, or a parameter that is subscripted or split."""
    for part in ast.walk(node):
        if isinstance(part, ast.Attribute) and part.attr == "data":
            return ast.unparse(part)
    arguments = {parameter.arg for parameter in function.args.args} - {"self"}
    for part in ast.walk(node):
        if not isinstance(part, ast.Name) or part is node or depth > _MAX_DEPTH:
            continue
        given = values_of(part.id, function)
        if len(given) == 1 and (found := _find_text_expression(function, given[0], depth + 1)) is not None:
            return found
        is_taken_apart = any(isinstance(other, ast.Subscript | ast.Attribute) for other in ast.walk(node))
        if not given and part.id in arguments and is_taken_apart:
            return part.id
    return None
