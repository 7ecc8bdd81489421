"""Coroutines that are created but never run, by Python's own warning: the cause, with the step."""

from __future__ import annotations

import ast
import re

from tutor.judge.edits import Edit, replace_node, replace_pattern
from tutor.judge.rewriting.node import NodeFile, node_files
from tutor.judge.source import called_name, calls_in
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_WARNING = re.compile(r"coroutine '(?:[\w<>]+\.)*(\w+)' was never awaited")


def unawaited_names(trace: Trace) -> list[str]:
    """The names of the coroutine functions that Python says were called but never awaited, each once."""
    warnings = (_WARNING.search(line.text) for line in trace.output)
    return list(dict.fromkeys(found[1] for found in warnings if found))


def diagnose_unawaited(trace: Trace) -> Cause | None:
    """Whether a callback is lost because it is an `async def` that is called like a function.

    rclpy awaits a callback only if the callback itself is an `async def`: not a lambda or a decorator's wrapper around
    one.
    """
    warned = unawaited_names(trace)
    for file in node_files(trace) if warned else ():
        step = file.step(_await_in_wrapper(file, warned), _without_async(file, warned))
        if step is not None:
            text = f"{warned[0]} is an async def: calling it only makes a coroutine, and nothing in it runs"
            return Cause("coroutine not awaited", text, step)
    return None


def _await_in_wrapper(file: NodeFile, warned: list[str]) -> list[Edit]:
    """Edits that let a decorator's wrapper await the function that it wraps."""
    for function in file.functions:
        decorators = [each.func if isinstance(each, ast.Call) else each for each in function.decorator_list]
        if function.name not in warned or not isinstance(function, ast.AsyncFunctionDef):
            continue
        for decorator in filter(None, map(file.function, decorators)):
            around = [each for each in ast.walk(decorator) if isinstance(each, ast.FunctionDef)]
            wrapped = {argument.arg for each in around for argument in each.args.args}
            for wrapper in around[1:]:
                calls = [
                    each
                    for each in calls_in(wrapper, *wrapped)
                    if isinstance(each.func, ast.Name) and file.function_around(each) is wrapper
                ]
                if calls:
                    awaited = [replace_node(file.text, each, f"await {ast.unparse(each)}") for each in calls]
                    head = replace_pattern(
                        file.text, rf"(?<!async )\bdef {wrapper.name}\b", f"async def {wrapper.name}"
                    )
                    return [*head, *awaited]
    return []


def _without_async(file: NodeFile, warned: list[str]) -> list[Edit]:
    """Edits that make functions of coroutine functions that await nothing and are not awaited."""
    awaited = {called_name(call) for each in file.nodes if isinstance(each, ast.Await) for call in calls_in(each)}
    found = [
        each
        for each in file.functions
        if isinstance(each, ast.AsyncFunctionDef)
        and each.name not in awaited
        and not any(isinstance(inner, ast.Await | ast.AsyncFor | ast.AsyncWith) for inner in ast.walk(each))
    ]
    if not any(each.name in warned for each in found):
        return []
    return [
        edit for each in found for edit in replace_pattern(file.text, rf"\basync def {each.name}\b", f"def {each.name}")
    ]
