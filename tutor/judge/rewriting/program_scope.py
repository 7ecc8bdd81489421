"""The program around a learner's node: where it is, and which of its statements set the node up."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tutor.judge.rewriting.node import NodeFile
from tutor.judge.source import Function, called_name, calls_in

SPINS = ("spin", "spin_once", "spin_some", "spin_until_future_complete")
EXECUTORS = ("SingleThreadedExecutor", "MultiThreadedExecutor", "EventsExecutor")
_REPLACED_CALLS = {
    *(*SPINS, *EXECUTORS, "add_node", "remove_node", "destroy_node", "shutdown", "try_shutdown", "install"),
    *("sleep", "join", "wait", "signal", "register", "exit", "_exit", "abort", "kill", "terminate", "on_shutdown"),
}
"""Calls by which a program spins its node and ends: a rewrite keeps none of them."""


@dataclass(frozen=True)
class Scope:
    """The statements of the program: the body of a function such as `main()`, or the end of the file."""

    body: Sequence[ast.stmt]
    function: Function | None


def find_scope(file: NodeFile) -> Scope | None:
    """The program: what is around rclpy.init(), or around what spins or creates the node, outside the node's class."""
    inits = [each for each in file.calls("init") if ast.unparse(each.func) in ("rclpy.init", "init")]
    making = file.calls(*file.node_classes, "create_node", "Node")
    for each in [*inits, *file.calls(*SPINS), *making]:
        function = file.function_around(each)
        if function is None:
            return _module_scope(file, each)
        if file.class_of(function) is None and not isinstance(function, ast.AsyncFunctionDef):
            return Scope(function.body, function)
    main = next((each for each in file.functions if each.name == "main" and file.class_of(each) is None), None)
    return Scope(main.body, main) if main is not None else None


def _module_scope(file: NodeFile, call: ast.Call) -> Scope | None:
    """The program around a call at module level; None within the body of a class."""
    around = [each for each in file.ancestors(call) if isinstance(each, ast.stmt)]
    if any(isinstance(each, ast.ClassDef) for each in around):
        return None
    outermost = around[-1] if around else file.statement(call)
    if isinstance(outermost, ast.If) and "__name__" in ast.unparse(outermost.test):
        return Scope(outermost.body, None)
    return Scope(file.tree.body[file.tree.body.index(outermost) :], None)


def setup_statements(file: NodeFile, body: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements of a program that set the node up, up to the one that spins."""
    removed_names: set[str] = set()
    for each in _flatten(body):
        if isinstance(each, ast.ClassDef):
            yield each
            continue
        calls = calls_in(each)
        read = {inner.id for inner in ast.walk(each) if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Load)}
        is_removed = isinstance(each, ast.While | ast.For | ast.Return | ast.Raise | ast.Pass)
        is_removed = is_removed or any(_is_replaced(call) for call in calls)
        if not (is_removed or read & removed_names or _has_no_setup(file, each)):
            yield each
            continue
        if isinstance(each, Function):
            removed_names.add(each.name)
        removed_names |= {
            inner.id for inner in ast.walk(each) if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Store)
        }
        if any(called_name(call) in SPINS for call in calls) and not isinstance(each, Function):
            return


def _has_no_setup(file: NodeFile, statement: ast.stmt) -> bool:
    """Whether a statement only calls a function that sets nothing up, node or parser, and discards the result."""
    if not isinstance(statement, ast.Expr) or not isinstance(call := statement.value, ast.Call):
        return False
    callee = file.function(call.func)
    inside = [call, *(each for one in (file.reachable_from(callee) if callee else []) for each in ast.walk(one))]
    names = [called_name(each) for each in inside if isinstance(each, ast.Call)]
    return not any(name.startswith(("create_", "declare_", "init", "add_on", "add_arg")) for name in names)


def _is_replaced(call: ast.Call) -> bool:
    """Whether a rewrite replaces a call: by its name, or because it is passed a spin, as a thread's target may be."""
    return called_name(call) in _REPLACED_CALLS or any(
        ast.unparse(each).rpartition(".")[2] in SPINS for each in (*call.args, *(k.value for k in call.keywords))
    )


def _flatten(body: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements, with the bodies of try and with statements in place of these."""
    for each in body:
        if isinstance(each, ast.Try | ast.With):
            yield from _flatten(each.body)
        else:
            yield each
