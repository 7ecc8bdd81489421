"""Why the executor never serves a node, as the learner's source shows: the cause, with the step."""

from __future__ import annotations

import ast
import re
import textwrap

from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import NodeFile, find_in_files, node_files
from tutor.judge.rewriting.program_scope import EXECUTORS
from tutor.judge.source import last_name
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_NODE_LISTS = tuple(f"self._{each}" for each in ("timers", "subscriptions", "services", "clients", "guards"))
_SPINS = "spin", "spin_once", "spin_until_future_complete"


def diagnose_unserved(trace: Trace) -> Cause | None:
    """Why the executor does not serve a node, as far as the source shows it: in one file, or in several together."""
    return find_in_files(trace, diagnose_unserved_node) or _diagnose_inner_node(trace)


def diagnose_unserved_node(file: NodeFile) -> Cause | None:
    """Whether executors cannot know what the node has to serve, or another node is spun in its place, or before it."""
    return (
        _diagnose_overwritten_attribute(file)
        or _diagnose_other_node_spun(file)
        or _diagnose_node_left_out(file)
        or _diagnose_node_taken(file)
        or _diagnose_second_spin(file)
        or _diagnose_spin_for_each(file)
        or _diagnose_executor_for_each(file)
    )


def _diagnose_other_node_spun(file: NodeFile) -> Cause | None:
    spins = [call for call in file.calls("spin") if len(call.args) == 1 and isinstance(call.args[0], ast.Name)]
    made = {file.assigned_to(call): call for call in file.calls(*file.node_classes)}
    helpers = {file.assigned_to(call) for call in file.calls("create_node", "Node")} - {""}
    if len(spins) != 1 or len(made) != 1 or "" in made or file.calls("add_node"):
        return None
    spun, (name, own) = spins[0].args[0], next(iter(made.items()))
    if ast.unparse(spun) not in helpers or file.function_around(own) is not file.function_around(spins[0]):
        return None
    step = file.step([edits.replace_node(file.text, spun, name)])
    text = f"{source.where(spins[0])} runs the callbacks of {ast.unparse(spun)}, not those of {name}"
    return Cause("another node spun", text, step) if step else None


def _diagnose_node_left_out(file: NodeFile) -> Cause | None:
    """Whether one of several nodes with callbacks is never spun."""
    spins = [call for call in file.calls("spin") if len(call.args) == 1 and isinstance(call.args[0], ast.Name)]
    if len(spins) != 1 or file.calls("add_node") or not isinstance(file.statement(spins[0]), ast.Expr):
        return None
    made = [call for call in file.calls(*file.node_classes) if _has_callbacks(file, call)]
    nodes = [file.assigned_to(each) for each in made if file.function_around(each) is file.function_around(spins[0])]
    spun = ast.unparse(spins[0].args[0])
    left_out = [each for each in nodes if each != spun]
    if spun not in nodes or not left_out or "" in nodes:
        return None
    step = file.step(_spin_in_place_of(file, spins[0], nodes))
    text = f"{source.where(spins[0])} runs the callbacks of {spun}, not those of {' and '.join(left_out)}"
    return Cause("another node spun", text, step) if step else None


def _diagnose_inner_node(trace: Trace) -> Cause | None:
    """Whether a node creates another one, and only the outer one is spun."""
    files = [*node_files(trace)]
    nodes = {name for file in files for name in file.node_classes}
    served = {last_name(each) for file in files for call in file.calls("add_node", *_SPINS) for each in call.args}
    for file in files:
        for call in file.calls(*nodes):
            outer, inner = file.class_of(call), file.assigned_to(call)
            if outer is None or outer.name not in nodes or not inner.startswith("self.") or inner[5:] in served:
                continue
            if any(_has_callbacks(each, call) for each in files):
                step = next((found for each in files if (found := _serve_inner_node(each, outer.name, inner[5:]))), "")
                text = f"{source.where(call)} creates another node, and only the one around it is spun"
                return Cause("another node spun", text, step) if step else None
    return None


def _serve_inner_node(file: NodeFile, outer: str, inner: str) -> str | None:
    """The step that lets the executor of the outer node, given by its class, serve the inner one as well."""
    made = {file.assigned_to(each) for each in file.calls(outer)} - {""}
    for call in file.calls("add_node", "spin"):
        node = ast.unparse(call.args[0]) if len(call.args) == 1 else ""
        statement = file.statement(call)
        if node not in made or not isinstance(statement, ast.Expr):
            continue
        both = [node, f"{node}.{inner}"]
        if source.called_name(call) == "spin":
            return file.step(_spin_in_place_of(file, call, both))
        return file.step([edits.insert_after(statement, f"{ast.unparse(call.func)}({both[1]})")])
    return None


def _has_callbacks(file: NodeFile, made: ast.Call) -> bool:
    """Whether the class of this node creates anything that an executor has to serve."""
    own = next(
        (each for each in file.nodes if isinstance(each, ast.ClassDef) and each.name == source.called_name(made)), None
    )
    return own is not None and bool(
        source.calls_in(own, "create_subscription", "create_timer", "create_service", "create_client")
    )


def _diagnose_overwritten_attribute(file: NodeFile) -> Cause | None:
    """Whether the node overwrites a list of rclpy's Node that executors read, such as `self._services`."""
    for each in file.nodes:
        if not isinstance(each, ast.Assign | ast.AnnAssign):
            continue
        targets = each.targets if isinstance(each, ast.Assign) else [each.target]
        taken = next((name for name in map(ast.unparse, targets) if name in _NODE_LISTS), None)
        if taken is None or file.node_method(each) is None:
            continue
        step = file.step(edits.replace_pattern(file.text, rf"\b{re.escape(taken)}\b", taken.replace("._", ".my_")))
        if step is not None:
            text = f"{source.where(each)} overwrites {taken}, by which rclpy's Node knows what it has to serve"
            return Cause("attribute of Node overwritten", text, step)
    return None


def _diagnose_node_taken(file: NodeFile) -> Cause | None:
    """Whether rclpy.spin_once(node) takes a node out of the executor that it was added to before."""
    owners = {
        ast.unparse(each.args[0]): each
        for each in file.calls("add_node")
        if len(each.args) == 1 and isinstance(each.func, ast.Attribute)
    }
    for call in file.calls("spin_once", "spin_until_future_complete"):
        added = owners.get(ast.unparse(call.args[0])) if call.args else None
        if added is None or added.lineno > call.lineno or file.function_around(added) is not file.function_around(call):
            continue
        assert isinstance(added.func, ast.Attribute)
        executor, method = ast.unparse(added.func.value), source.called_name(call)
        own = ast.Call(ast.parse(f"{executor}.{method}", mode="eval").body, call.args[1:], call.keywords)
        step = file.step([edits.replace_node(file.text, call, ast.unparse(own))])
        text = (
            f"{source.where(call)} moves the node to an executor of its own, and takes it out of {executor}, "
            "which then has nothing to run"
        )
        return Cause("node taken from its executor", text, step) if step else None
    return None


def _diagnose_second_spin(file: NodeFile) -> Cause | None:
    """Whether a node is spun only after another one, whose spin returns when the program ends."""
    spins = [each for each in file.calls("spin") if isinstance(file.statement(each), ast.Expr)]
    for first in spins:
        block = file.block_of(file.statement(first))
        later = [each for each in spins if each is not first and file.statement(each) in block]
        if all(ast.unparse(each) == ast.unparse(first) for each in later):
            continue
        step = file.step(_spin_together(file, first, later))
        text = f"{source.where(later[0])} is never reached, because line {first.lineno} spins until the program ends"
        return Cause("second spin", text, step) if step else None
    return None


def _diagnose_spin_for_each(file: NodeFile) -> Cause | None:
    """Whether several nodes are spun one after the other in a `for` loop."""
    for loop in (each for each in file.nodes if isinstance(each, ast.For)):
        spin = next((each for each in file.calls("spin") if file.statement(each) in loop.body), None)
        if spin is None:
            continue
        added = [*spin.args, *(argument for each in source.calls_in(loop, "add_node") for argument in each.args)]
        if not added:
            return None
        name, imported = file.import_name("MultiThreadedExecutor", "rclpy.executors")
        replaced = ("spin", "add_node", "SingleThreadedExecutor", "MultiThreadedExecutor")
        kept = [ast.unparse(each) for each in loop.body if not source.calls_in(each, *replaced)]
        body = "\n".join(
            textwrap.indent(each, "    ") for each in (*kept, f"executor.add_node({ast.unparse(added[0])})")
        )
        head = f"for {ast.unparse(loop.target)} in {ast.unparse(loop.iter)}:"
        code = f"executor = {name}()\n{head}\n{body}\nexecutor.spin()"
        step = file.step([edits.replace_statement(loop, code), *imported])
        text = (
            f"{source.where(spin)} spins the first node of the loop until the program ends: the others never get "
            "their turn"
        )
        return Cause("second spin", text, step) if step else None
    return None


def _diagnose_executor_for_each(file: NodeFile) -> Cause | None:
    """Whether a `for` loop creates an executor for each node, of which only the last one is spun."""
    for loop in (each for each in file.nodes if isinstance(each, ast.For)):
        for made in source.calls_in(loop, *EXECUTORS):
            executor, statement = file.assigned_to(made), file.statement(made)
            added, spun = (
                [each for each in file.calls(name) if ast.unparse(each.func) == f"{executor}.{name}"]
                for name in ("add_node", "spin")
            )
            if statement not in loop.body or not any(file.statement(each) in loop.body for each in added):
                continue
            if not spun or any(spin in ast.walk(loop) for spin in spun):
                continue
            above = edits.insert_above(loop.lineno, ast.unparse(statement))
            step = file.step([above, edits.remove_statement(file.text, statement)])
            text = (
                f"{source.where(made)} creates an executor for each node, and line {spun[0].lineno} spins only the last"
            )
            return Cause("another executor for each node", text, step) if step else None
    return None


def _spin_together(file: NodeFile, first: ast.Call, later: list[ast.Call]) -> list[Edit]:
    """Let one executor with several threads spin the nodes of all these calls."""
    removed = [edits.remove_statement(file.text, file.statement(each)) for each in later]
    if all(len(each.args) == 1 for each in (first, *later)):  # rclpy.spin(node)
        return [*_spin_in_place_of(file, first, [ast.unparse(each.args[0]) for each in (first, *later)]), *removed]
    owners = [ast.unparse(each.func.value) for each in (first, *later) if isinstance(each.func, ast.Attribute)]
    moved = [
        edits.replace_node(file.text, each.func.value, owners[0])
        for each in file.calls("add_node")
        if isinstance(each.func, ast.Attribute) and ast.unparse(each.func.value) in owners[1:]
    ]
    return [*moved, *removed] if moved and not any(each.args for each in (first, *later)) else []


def _spin_in_place_of(file: NodeFile, spin: ast.Call, nodes: list[str]) -> list[Edit]:
    """Spin all these nodes, given as expressions, with one executor in place of this call."""
    name, imported = file.import_name("MultiThreadedExecutor", "rclpy.executors")
    added = [f"executor.add_node({each})" for each in nodes]
    code = "\n".join([f"executor = {name}()", *added, "executor.spin()"])
    return [edits.replace_statement(file.statement(spin), code), *imported]
