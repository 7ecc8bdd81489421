"""Why the code that makes the node's publishers, services or timers is never reached."""

from __future__ import annotations

import ast

from tutor.judge.edits import Edit, append_to_function, insert_above, insert_after, remove_statement
from tutor.judge.rewriting.node import NodeFile, node_files
from tutor.judge.rewriting.program_scope import SPINS
from tutor.judge.source import Function, called_name, calls_in
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


def diagnose_uncalled_setup(file: NodeFile, create: str) -> Cause | None:
    """Whether a call of `create`, such as "create_service", is in a function that nothing calls or mentions."""
    for call in file.calls(create):
        function = file.function_around(call)
        if function is None or _is_mentioned(file, function):
            continue
        step = file.step(_call(file, function))
        if step is not None:
            text = f"line {call.lineno}: {create}() is in {function.name}(), which nothing calls"
            return Cause("setup not called", text, step)
    return None


def diagnose_awaited_service(trace: Trace) -> Cause | None:
    """Whether the program waits for a service that nobody offers, before it makes what is missing."""
    offered = {each.name for each in trace.graph.servers}
    awaited = sorted({each.name for each in trace.graph.clients if each.name not in offered})
    if not awaited:
        return None
    for file in node_files(trace):
        for loop in (each for each in file.nodes if isinstance(each, ast.While)):
            waits = calls_in(loop.test, "wait_for_service", "service_is_ready")
            step = file.step([remove_statement(file.text, loop)]) if waits else None
            if step is not None:
                text = f"line {loop.lineno} waits for {awaited[0]}, which nobody offers, before it goes on"
                return Cause("waits for a service", text, step)
    return None


def _is_mentioned(file: NodeFile, function: Function) -> bool:
    if function.name.startswith("__") or function.decorator_list:
        return True
    modules = [(alias.asname or alias.name) for each, alias in file.imports if isinstance(each, ast.Import)]
    for each in file.nodes:
        match each:
            case ast.Attribute(value=value, attr=name) if name == function.name and ast.unparse(value) not in modules:
                return True
            case ast.Name(id=name) | ast.Constant(value=name) if name == function.name:
                return True
    return False


def _call(file: NodeFile, function: Function) -> list[Edit]:
    """Call a function once at the start: at the end of the constructor, else when the node exists."""
    owner = file.class_of(function)
    needed = len(function.args.args) - len(function.args.defaults) - (owner is not None)
    if owner is None:
        spins = [each for each in file.calls(*SPINS) if each.args and isinstance(file.statement(each), ast.Expr)]
        if not spins or needed > 1 or not isinstance(spins[0].args[0], ast.Name):
            return []
        given = spins[0].args[0].id if needed else ""
        return [insert_above(file.statement(spins[0]).lineno, f"{function.name}({given})")]
    if needed:
        return []
    own = next((each for each in owner.body if isinstance(each, Function) and each.name == "__init__"), None)
    if own is not None and own.args.args:
        return [append_to_function(own, f"{own.args.args[0].arg}.{function.name}()")]
    for each in file.nodes:
        match each:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call() as made) if called_name(made) == owner.name:
                return [insert_after(each, f"{name}.{function.name}()")]
    return []
