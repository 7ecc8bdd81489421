"""Late binding: functions made in a loop that all see the values from its last iteration."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from tutor.judge import source
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_Closure = ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef


def diagnose_late_binding(trace: Trace, observed: str = "") -> Cause | None:
    """Whether a function made in a loop reads the loop's variables when it is called; `observed`: words in front."""
    late = next(_find_late_bindings(trace), None)
    if late is None:
        return None
    file, function, names = late
    kind = "lambda" if isinstance(function, ast.Lambda) else f"function {function.name}"
    listed = " and ".join(names)
    holds = "it has the value" if len(names) == 1 else "they have the values"
    step = _bind_names(trace.sources[file], function, names)
    return Cause(
        "late binding",
        f"{observed}the {kind} in line {function.lineno}, made in a loop, looks "
        f"{listed} up when it is called, and by then {holds} from the last iteration",
        f"in {file}, {step}" if len(trace.sources) > 1 or file != trace.file else step,
    )


def _find_late_bindings(trace: Trace) -> Iterator[tuple[str, _Closure, list[str]]]:
    """Yield each function made in a loop that reads the loop's variables: its file, the function, their names."""
    for file, text in trace.sources.items():
        for loop in source.syntax_nodes(text):
            if isinstance(loop, ast.For):
                variables, inside = {*_assigned(loop)}, [each for part in loop.body for each in ast.walk(part)]
            elif isinstance(loop, ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp):
                variables = {name for each in loop.generators for name in _assigned(each.target)}
                inside = list(ast.walk(loop))
            else:
                continue
            for function in (each for each in inside if isinstance(each, _Closure)):
                body = function.body if isinstance(function.body, list) else [function.body]
                read = [each for part in body for each in ast.walk(part) if isinstance(each, ast.Name)]
                parameters = {each.arg for each in ast.walk(function.args) if isinstance(each, ast.arg)}
                local = parameters | {each.id for each in read if not isinstance(each.ctx, ast.Load)}
                if names := list(dict.fromkeys(each.id for each in read if each.id in variables - local)):
                    yield file, function, names


def _assigned(node: ast.AST) -> list[str]:
    """The variables assigned in this node, functions inside it left out."""
    found = [node.id] if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) else []
    children = () if isinstance(node, _Closure) else ast.iter_child_nodes(node)
    return found + [name for each in children for name in _assigned(each)]


def _bind_names(text: str, function: _Closure, names: Sequence[str]) -> str:
    """Step: bind the names when the function is made, as default values of parameters."""
    defaults = ", ".join(f"{name}={name}" for name in names)
    parts = [each for each in ast.walk(function.args) if isinstance(each, ast.arg | ast.expr)]
    ends = [(each.end_lineno or 0, each.end_col_offset or 0) for each in parts]
    if not ends or function.args.kwarg:
        return f"line {function.lineno}: add {defaults} to its parameters"
    number, column = max(ends)
    line = text.splitlines()[number - 1].encode()
    return f"line {number} becomes: {(line[:column] + f', {defaults}'.encode() + line[column:]).decode().strip()}"
