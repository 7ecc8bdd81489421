"""I1.3: services that compute what another one should: which line of the server mixes them up, and what it becomes."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from checks.i1_3.facts import SIGNS, right_result
from tutor.judge import source
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Cause

_PYTHON = {**SIGNS, "/divide": "//"}
_Closure = ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef


def of_loop(trace: Trace, answers: Sequence[CallAnswer]) -> Cause | None:
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


def of_service(trace: Trace, service: str) -> str | None:
    """The step that makes a service compute its own: the line with the wrong callback, or the one with its result."""
    for file, text in trace.sources.items():
        for call in (each for each in source.tree(text) if isinstance(each, ast.Call)):
            if source.called(call) == "create_service" and _named(call, service) and (given := _callback(call)):
                return next((f"in {file}, {step}" for step in _steps(text, given, service)), None)
    return None


def _of(service: str, answer: CallAnswer) -> int:
    return right_result(service, answer.request["a"], answer.request["b"])


def _late(trace: Trace) -> Iterator[tuple[str, _Closure, list[str]]]:
    """Functions made in a loop, with the variables of the loop that they read: the file, the function, the names."""
    for file, text in trace.sources.items():
        for loop in source.tree(text):
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


def _named(call: ast.Call, service: str) -> bool:
    given = [*call.args, *(each.value for each in call.keywords)]
    return any(isinstance(each, ast.Constant) and f"/{str(each.value).strip('/')}" == service for each in given)


def _callback(call: ast.Call) -> ast.expr | None:
    named = (each.value for each in call.keywords if each.arg == "callback")
    return call.args[2] if len(call.args) > 2 else next(named, None)


def _steps(text: str, given: ast.expr, service: str) -> Iterator[str]:
    functions = {each.name: each for each in source.tree(text) if isinstance(each, ast.FunctionDef)}
    name = given.attr if isinstance(given, ast.Attribute) else given.id if isinstance(given, ast.Name) else ""
    if name in functions and not _means(name, service):
        for other in (each for each in functions if _means(each, service)):
            line = text.splitlines()[given.lineno - 1].encode()
            end = given.end_col_offset or 0
            becomes = line[: end - len(name.encode())] + other.encode() + line[end:]
            yield f"line {given.lineno} becomes: {becomes.decode().strip()}"
    if name in functions:
        for each in ast.walk(functions[name]):
            if isinstance(each, ast.Assign) and isinstance(each.targets[0], ast.Attribute):
                a, b = (_operand(each.value, one) for one in "ab")
                if each.targets[0].attr == "sum" and a and b:
                    target = ast.unparse(each.targets[0])
                    yield f"line {each.lineno} becomes: {target} = {a} {_PYTHON[service]} {b}"


def _means(function: str, service: str) -> bool:
    """Whether a function is named after this service, and not after another as well."""
    called = [each for each in SIGNS if each[1:4] in function.casefold()]
    return called == [service]


def _operand(value: ast.expr, name: str) -> str:
    found = (each for each in ast.walk(value) if isinstance(each, ast.Name | ast.Attribute))
    return next((ast.unparse(e) for e in found if (e.id if isinstance(e, ast.Name) else e.attr) == name), "")
