"""What a learner's source says, for the words of a diagnosis: a next step must not advise what is there already.

Never for a verdict. A file that Python cannot read says nothing.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import lru_cache

from tutor.judge.trace import Trace


def nodes(trace: Trace) -> Iterator[ast.AST]:
    """All nodes of the syntax trees of the learner's files."""
    for text in trace.sources.values():
        yield from ast.walk(_parsed(text))


def tree(text: str) -> list[ast.AST]:
    """All nodes of the syntax tree of one file, by its text: the same ones each time."""
    return list(ast.walk(_parsed(text)))


def mentions(trace: Trace, *names: str) -> bool:
    """Whether one of these names is used anywhere, as a variable, a function or an attribute."""
    wanted = set(names)
    return any(
        (isinstance(node, ast.Name) and node.id in wanted) or (isinstance(node, ast.Attribute) and node.attr in wanted)
        for node in nodes(trace)
    )


def calls(trace: Trace, *names: str) -> list[ast.Call]:
    """The calls of functions and methods of these names, in the order in which they are written."""
    wanted = set(names)
    found = [node for node in nodes(trace) if isinstance(node, ast.Call) and called(node) in wanted]
    return sorted(found, key=lambda call: call.lineno)


def assigned(trace: Trace, *names: str) -> list[tuple[str, int]]:
    """What the results of calls of these names are assigned to, such as ("self.client", 14), with the line's number.

    Empty where it is no single name or attribute.
    """
    wanted = set(names)
    found = []
    for node in nodes(trace):
        if isinstance(node, ast.Assign | ast.AnnAssign) and isinstance(node.value, ast.Call):
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            if called(node.value) in wanted:
                plain = isinstance(target, ast.Name | ast.Attribute)
                found.append((ast.unparse(target) if plain else "", node.end_lineno or node.lineno))
    return sorted(found, key=lambda each: each[1])


def callbacks(trace: Trace, create: str) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
    """The functions that are given to `create`, such as "create_subscription", and those that they call, by name."""
    functions: dict[str, list[ast.FunctionDef | ast.AsyncFunctionDef]] = {}
    for node in nodes(trace):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            functions.setdefault(node.name, []).append(node)
    given = [each for call in calls(trace, create) for each in (*call.args, *(k.value for k in call.keywords))]
    inside = (node for each in given if isinstance(each, ast.Lambda) for node in ast.walk(each))
    waiting = [_name(each) for each in given] + [called(node) for node in inside if isinstance(node, ast.Call)]
    found: dict[str, None] = {}
    while waiting:
        name = waiting.pop(0)
        if name in functions and name not in found:
            found[name] = None
            inside = (node for function in functions[name] for node in ast.walk(function))
            waiting += [called(node) for node in inside if isinstance(node, ast.Call)]
    return [function for name in found for function in functions[name]]


def handlers(trace: Trace) -> list[ast.ExceptHandler]:
    """The `except` clauses, in the order in which they are written."""
    return sorted((node for node in nodes(trace) if isinstance(node, ast.ExceptHandler)), key=lambda each: each.lineno)


def comparisons(trace: Trace, value: object) -> list[ast.If]:
    """The `if` statements that ask whether something is equal to this value, in the order in which they are written."""

    def asks(test: ast.expr) -> bool:
        return (
            isinstance(test, ast.Compare)
            and isinstance(test.ops[0], ast.Eq)
            and any(isinstance(each, ast.Constant) and each.value == value for each in (test.left, *test.comparators))
        )

    found = [node for node in nodes(trace) if isinstance(node, ast.If) and asks(node.test)]
    return sorted(found, key=lambda each: each.lineno)


def function_at(trace: Trace, file: str, line: int) -> ast.FunctionDef | ast.AsyncFunctionDef | None:
    """The innermost function of the file that this line is in."""
    found = [
        node
        for node in ast.walk(_parsed(trace.sources.get(file, "")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.lineno <= line <= (node.end_lineno or 0)
    ]
    return max(found, key=lambda node: node.lineno, default=None)


def called(call: ast.Call) -> str:
    """The last part of the name of what is called; empty where it has none."""
    return _name(call.func)


def _name(expression: ast.expr) -> str:
    match expression:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name
    return ""


@lru_cache(maxsize=32)
def _parsed(text: str) -> ast.Module:
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])
