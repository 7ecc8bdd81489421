"""I1.2: what a learner's expression makes of a message's text, worked out here without running any of their code."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass

from tutor.judge.source import Function, values_of

EXAMPLES = ("Hello World: 107", "Hello World: 38", "Hello World: 4")

_METHODS = frozenset(
    {"split", "rsplit", "partition", "rpartition", "strip", "lstrip", "rstrip", "replace", "removeprefix", "lower"}
)
_DEEPEST = 12


class _Unknown(Exception):
    """The expression cannot be worked out."""


@dataclass(frozen=True, slots=True)
class _Reader:
    """Works out expressions of one function, in which what holds the message's text stands for `text`."""

    function: Function
    text: str

    def value(self, node: ast.expr, depth: int = 0) -> object:
        """What the expression comes to. Raises _Unknown, or what Python would raise."""
        if depth > _DEEPEST:
            raise _Unknown
        match node:
            case ast.Constant(value=str() | int() as plain):
                return plain
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() as plain)):
                return -plain
            case ast.Attribute(attr="data"):
                return self.text
            case ast.Name(id=name):
                return self._named(name, depth)
            case ast.Subscript(value=inner, slice=ast.Slice(lower=lower, upper=upper, step=None)):
                whole = self.value(inner, depth + 1)
                if isinstance(whole, str | list | tuple):
                    return whole[self._end(lower, depth) : self._end(upper, depth)]
            case ast.Subscript(value=inner, slice=index):
                whole, at = self.value(inner, depth + 1), self.value(index, depth + 1)
                if isinstance(whole, str | list | tuple) and isinstance(at, int):
                    return whole[at]
            case ast.Call(func=ast.Attribute(value=inner, attr=name), args=given, keywords=[]) if name in _METHODS:
                whole = self.value(inner, depth + 1)
                if isinstance(whole, str):
                    return getattr(whole, name)(*(self.value(each, depth + 1) for each in given))
            case ast.Call(func=ast.Name(id="int"), args=[inner], keywords=[]):
                read = self.value(inner, depth + 1)
                if isinstance(read, str | int):
                    return int(read)
        raise _Unknown

    def _end(self, node: ast.expr | None, depth: int) -> int | None:
        """One end of a slice."""
        at = None if node is None else self.value(node, depth + 1)
        if at is None or isinstance(at, int):
            return at
        raise _Unknown

    def _named(self, name: str, depth: int) -> object:
        given = values_of(name, self.function)
        if len(given) == 1:
            return self.value(given[0], depth + 1)
        if not given and name in {each.arg for each in self.function.args.args}:
            return self.text
        raise _Unknown


@dataclass(frozen=True, slots=True)
class Misread:
    """Where a number is taken from the wrong place of the text: what it reads there, and the `right` code."""

    node: ast.Call
    text: str
    right: str


def find_misread(functions: Sequence[Function]) -> Misread | None:
    """Whether the number is taken from the wrong place of the text."""
    for function in functions:
        for node in ast.walk(function):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "int" and node.args:
                for text in EXAMPLES:
                    if (found := _of_one(function, node, text)) is not None:
                        return found
    return None


def _of_one(function: Function, node: ast.Call, text: str) -> Misread | None:
    base = _text_of(function, node)
    if base is None:
        return None
    reader, right = _Reader(function, text), int(text.rpartition(":")[2])
    try:
        read = reader.value(node)
    except (ValueError, IndexError, TypeError):
        reads = "no number out of"
    except _Unknown:
        return None
    else:
        if read == right:
            return None
        reads = f"{read!r} out of"
    says = f"line {node.lineno}: {ast.unparse(node)} reads {reads} “{text}”"
    return Misread(node, says, f"int({base}.rpartition(':')[2])")


def _text_of(function: Function, node: ast.expr, depth: int = 0) -> str | None:
    """What holds the message's text in this expression, as written: msg.data, or an argument that is taken apart."""
    for each in ast.walk(node):
        if isinstance(each, ast.Attribute) and each.attr == "data":
            return ast.unparse(each)
    arguments = {each.arg for each in function.args.args} - {"self"}
    for each in ast.walk(node):
        if not isinstance(each, ast.Name) or each is node or depth > _DEEPEST:
            continue
        given = values_of(each.id, function)
        if len(given) == 1 and (found := _text_of(function, given[0], depth + 1)) is not None:
            return found
        apart = any(isinstance(other, ast.Subscript | ast.Attribute) for other in ast.walk(node))
        if not given and each.id in arguments and apart:
            return each.id
    return None
