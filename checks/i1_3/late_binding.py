"""I1.3: services that compute what another one should: which line of the server mixes them up, and what it becomes."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from checks.i1_3.facts import SIGNS, right_result
from tutor.judge import source
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Cause

_Closure = ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef


def diagnose_loop(trace: Trace, answers: Sequence[CallAnswer]) -> Cause | None:
    """Whether all services compute the same, and functions made in a loop read the loop's variables when called."""
    told = [each for each in answers if each.response is not None and each.request["a"] and each.request["b"]]
    if len({each.service for each in told}) < 2:
        return None
    same = [name for name in SIGNS if all(each.response and each.response["sum"] == _of(name, each) for each in told)]
    late = next(_late(trace), None)
    if not same or late is None:
        return None
    file, function, names = late
    kind = "lambda" if isinstance(function, ast.Lambda) else f"function {function.name}"
    listed = " and ".join(names)
    what = "it is" if len(names) == 1 else "they are"
    return Cause(
        "late binding",
        f"all services compute what {same[0]} should: the {kind} in line {function.lineno}, made in a loop, looks "
        f"{listed} up when it is called, and by then {what} what the last turn of the loop has left",
        f"in {file}, {_bound(trace.sources[file], function, names)}",
    )


def _of(service: str, answer: CallAnswer) -> int:
    return right_result(service, answer.request["a"], answer.request["b"])


def _late(trace: Trace) -> Iterator[tuple[str, _Closure, list[str]]]:
    """Functions made in a loop, with the variables of the loop that they read: the file, the function, the names."""
    for file, text in trace.sources.items():
        for loop in source.syntax_nodes(text):
            if isinstance(loop, ast.For):
                own, inside = {*_stored(loop)}, [each for part in loop.body for each in ast.walk(part)]
            elif isinstance(loop, ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp):
                own, inside = {name for each in loop.generators for name in _stored(each.target)}, list(ast.walk(loop))
            else:
                continue
            for function in (each for each in inside if isinstance(each, _Closure)):
                body = function.body if isinstance(function.body, list) else [function.body]
                read = [each for part in body for each in ast.walk(part) if isinstance(each, ast.Name)]
                given = {each.arg for each in ast.walk(function.args) if isinstance(each, ast.arg)}
                mine = given | {each.id for each in read if not isinstance(each.ctx, ast.Load)}
                if names := list(dict.fromkeys(each.id for each in read if each.id in own - mine)):
                    yield file, function, names


def _stored(node: ast.AST) -> list[str]:
    """The variables that are set here, outside of functions."""
    found = [node.id] if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) else []
    children = () if isinstance(node, _Closure) else ast.iter_child_nodes(node)
    return found + [name for each in children for name in _stored(each)]


def _bound(text: str, function: _Closure, names: Sequence[str]) -> str:
    """The step that binds the names when the function is made."""
    more = ", ".join(f"{name}={name}" for name in names)
    parts = [each for each in ast.walk(function.args) if isinstance(each, ast.arg | ast.expr)]
    ends = [(each.end_lineno or 0, each.end_col_offset or 0) for each in parts]
    if not ends or function.args.kwarg:
        return f"line {function.lineno}: add {more} to its parameters"
    number, column = max(ends)
    line = text.splitlines()[number - 1].encode()
    return f"line {number} becomes: {(line[:column] + f', {more}'.encode() + line[column:]).decode().strip()}"
