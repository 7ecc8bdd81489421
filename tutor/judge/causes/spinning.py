"""Why a node's callbacks never run: the line at which the program is stuck, or ends, and what to write there."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from tutor.judge import edits, source, tracebacks
from tutor.judge.causes import names
from tutor.judge.edits import Edit
from tutor.judge.rewriting.callbacks import Loop, only_waits, outermost
from tutor.judge.rewriting.node import NodeFile, file_of, started_node
from tutor.judge.rewriting.program_scope import SPINS
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause

SPINS_ONCE = "spin_once", "spin_some"
_CLEANUP = "destroy_node", "shutdown", "try_shutdown", "exit", "_exit"


def is_spinning(stuck: Sequence[Frame]) -> bool:
    """Whether a stack dump shows an rclpy executor at work."""
    return any(frame.path.endswith("rclpy/executors.py") for frame in stuck)


def diagnose_not_spinning(trace: Trace, stuck: Sequence[Frame], nodes: str) -> Cause | None:
    """Where the program is stuck instead of spinning; None if unknown, or if it does spin.

    `stuck`: a stack dump of its threads. `nodes`: the names of its nodes, for the text.
    """
    mains = [thread for thread in tracebacks.frames_by_thread(stuck) if thread[-1].function == "<module>"]
    at = tracebacks.own_frame(mains[0] if mains else stuck, trace.folder)
    if at is None or "spin" in at.code or is_spinning(stuck):
        return None
    loop = outermost(file_of(trace, at), at.line)
    where = f"at {at}" + (
        f", in the loop of {_describe_loop(loop)}" if loop is not None and loop.lineno != at.line else ""
    )
    return Cause(
        names.NO_SPIN,
        f"{nodes} exists, but answers no request: its callbacks are never run. The program stays {where}",
        _spin_instead(trace, at, loop),
    )


def diagnose_spin_in_constructor(file: NodeFile) -> Cause | None:
    """Whether a node spins before its constructor has made everything, and so never gets to the rest."""
    created = [
        each
        for each in file.nodes
        if isinstance(each, ast.Assign | ast.Expr)
        and isinstance(each.value, ast.Call)
        and source.called_name(each.value) in file.node_classes
    ]
    for statement in _interruptible_statements(file) if created else ():
        if _spins_itself(file, statement):
            step = file.step([_spin_after(created[-1]), edits.remove_statement(file.text, statement)])
            text = f"line {statement.lineno}: {ast.unparse(statement)} spins in the constructor, which ends only then"
            return Cause(names.NO_SPIN, text, step) if step else None
    return None


def diagnose_nap_between_spins(file: NodeFile) -> Cause | None:
    """Whether the loop that spins the node sleeps between one callback and the next."""
    for loop in file.nodes:
        if isinstance(loop, ast.While) and source.calls_in(loop, *SPINS_ONCE):
            for nap in source.calls_in(loop, "sleep"):
                step = file.step([edits.remove_statement(file.text, file.statement(nap))])
                text = f"{source.where(nap)}: the loop sleeps here, and meanwhile runs no callback"
                return Cause("nap between callbacks", text, step) if step else None
    return None


def diagnose_untimed_spin_once(file: NodeFile) -> Cause | None:
    """Whether a loop that publishes by itself stops in spin_once(), which waits for a callback: there is no timer."""
    if file.timers or file.calls("create_subscription"):
        return None
    for loop in file.nodes:
        if not isinstance(loop, ast.While) or not _publishes(file, loop):
            continue
        for call in source.calls_in(loop, *SPINS_ONCE):
            if any(each.arg == "timeout_sec" for each in call.keywords) or not isinstance(call.func, ast.Attribute):
                continue
            text = (
                f"{source.where(call)} waits until a callback runs, and without a timer there is none, except when "
                "somebody asks for a parameter: the loop stops here"
            )
            return Cause("spin_once waits", text, file.step(_spin_for_a_period(file, loop, call)) or "")
    return None


def diagnose_untimed_spins_in_turn(file: NodeFile) -> Cause | None:
    """Whether a loop spins one node after the other without a timeout, so that all of them wait for each."""
    for loop in file.nodes:
        if not isinstance(loop, ast.For) or not isinstance(loop.target, ast.Name):
            continue
        for call in source.calls_in(loop, "spin_once"):
            given = [*call.args, *(each.value for each in call.keywords)]
            if not call.args or any(each.arg == "timeout_sec" for each in call.keywords):
                continue
            if loop.target.id in map(ast.unparse, given):
                spin = f"{ast.unparse(call)[:-1]}, timeout_sec=0.1)"
                text = (
                    f"{source.where(call)} waits until this node has something to do, and until then none of the "
                    "others gets a turn"
                )
                return Cause("spin_once waits", text, file.step(edits.replace_nodes(file.text, (call, spin))) or "")
    return None


def _publishes(file: NodeFile, loop: Loop) -> bool:
    """Whether a loop publishes, itself or in a function that it calls."""
    functions = [found for call in source.calls_in(loop) if (found := file.function(call.func)) is not None]
    reached = [each for function in functions for each in file.reachable_from(function)]
    return bool(source.calls_in(loop, "publish")) or any(
        file.function_around(p) in reached for p in file.calls("publish")
    )


def _spin_for_a_period(file: NodeFile, loop: ast.While, spin: ast.Call) -> list[Edit]:
    """Run callbacks for as long as the loop sleeps, in place of the sleep."""
    own = [each for each in loop.body if isinstance(each, ast.Expr) and isinstance(each.value, ast.Call)]
    nap = next((each for each in own if source.calls_in(each, "sleep")), None)
    once = file.statement(spin)
    if nap is None or once not in own or not isinstance(nap.value, ast.Call) or len(nap.value.args) != 1:
        return []
    known = file.imported_name("monotonic", "time")
    now, imported = known or "time.monotonic", [] if known else edits.add_import(file.text, "import time")
    arguments = ", ".join([*map(ast.unparse, spin.args), "timeout_sec=left"])
    code = (
        f"wake_up = {now}() + {ast.unparse(nap.value.args[0])}\n"
        f"while (left := wake_up - {now}()) > 0:\n    {ast.unparse(spin.func)}({arguments})"
    )
    return [edits.replace_statement(nap, code), edits.remove_statement(file.text, once), *imported]


def _spin_after(created: ast.Assign | ast.Expr) -> Edit:
    """Spin the node below the statement that creates it."""
    if isinstance(created, ast.Assign):
        return edits.insert_after(created, f"rclpy.spin({ast.unparse(created.targets[0])})")
    return edits.replace_statement(created, f"rclpy.spin({ast.unparse(created.value)})")


def _interruptible_statements(file: NodeFile) -> Iterator[ast.stmt]:
    """The statements of a node's constructor, or of a base class's, after which there is more to do."""
    classes = [each for each in file.nodes if isinstance(each, ast.ClassDef)]
    bases = {ast.unparse(base) for each in classes for base in each.bases}
    for owner in classes:
        if owner.name in file.node_classes:
            for each in owner.body:
                if isinstance(each, ast.FunctionDef) and each.name == "__init__":
                    yield from each.body if owner.name in bases else each.body[:-1]


def _spins_itself(file: NodeFile, statement: ast.stmt) -> bool:
    """Whether a statement, or a function that it calls, spins `self`."""
    called = [
        found
        for call in source.calls_in(statement)
        if (found := file.function(call.func)) is not None and statement not in found.body
    ]
    spins = [call for each in (statement, *called) for call in source.calls_in(each, "spin")]
    return any("self" in map(ast.unparse, call.args) for call in spins)


def _spin_instead(trace: Trace, at: Frame, loop: Loop | None) -> str:
    """The step that replaces the line, or the loop, at which the program is stuck by a timer and a spin."""
    file = file_of(trace, at)
    function = file.function_at(at.line)
    is_method = (
        function is not None and function.name != "main" and "self" in [each.arg for each in function.args.args[:1]]
    )
    node = "self" if is_method else _node_name(trace)
    spin = "" if is_method or _has_spin(trace, function) else f"rclpy.spin({node})"
    statement = loop or file.statement_at(at.line)
    if statement is None:
        return f"take out line {at.line}, {at.code}: let a timer do what has to wait, while the node spins"
    lines = statement.lineno, statement.end_lineno or statement.lineno
    code = spin
    if loop is not None and (work := [each for each in loop.body if not only_waits(each)]):
        period = next((ast.unparse(call.args[0]) for call in source.calls_in(loop, "sleep") if call.args), "1.0")
        callback, defined = _timer_callback(loop, work, function)
        code = "\n".join([*defined, f"{node}.create_timer({period}, {callback})", *([spin] if spin else [])])
    edit = edits.replace_lines(lines[0], code, lines[1]) if code else edits.remove_lines(file.text, *lines)
    return file.step([edit]) or (
        f"move what lines {lines[0]} to {lines[1]} do, without the sleep, into a callback of a timer, and spin the node"
    )


def _timer_callback(loop: Loop, work: Sequence[ast.stmt], function: source.Function | None) -> tuple[str, list[str]]:
    """The name of a function that does one iteration of a loop, and the lines that define it, unless it exists."""
    if len(work) == 1 and (called := _plain_call(work[0])) is not None:
        return called, []
    inside = [each for statement in loop.body for each in ast.walk(statement)]
    stored = {each.id for each in inside if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)}
    around = [each for each in ast.walk(function) if each not in inside] if function is not None else []
    outer = {each.id for each in around if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)}
    shared = sorted(stored & outer if function is not None else stored)
    test = ast.unparse(loop.test) if isinstance(loop, ast.While) else "True"
    body = [line for each in work for line in ast.unparse(each).replace("continue", "return").splitlines()]
    if test not in ("True", "1", "rclpy.ok()"):
        body = [f"if {test}:", *(f"    {line}" for line in body)]
    declared = [f"{'nonlocal' if function is not None else 'global'} {', '.join(shared)}"] if shared else []
    return "on_timer", ["def on_timer():", *(f"    {line}" for line in (*declared, *body))]


def diagnose_early_end(trace: Trace, ended: str) -> Cause | None:
    """Why a program ends by itself: it never spins, or spins only once. `ended`: words on how it ended."""
    if not trace.sources or source.calls(trace, "spin"):
        return None
    in_loops = {id(call) for loop in source.all_nodes(trace) if isinstance(loop, Loop) for call in ast.walk(loop)}
    once = source.calls(trace, "spin_once", "spin_some")
    if once and not any(id(call) in in_loops for call in once):
        code = ast.unparse(once[0])
        return Cause(
            names.EXIT_AT_ONCE,
            f"{ended}: line {once[0].lineno}, {code}, handles one callback at most, and then the program runs to its "
            "end",
            f"line {once[0].lineno} becomes: {_as_spin(once[0])}",
        )
    if source.calls(trace, *SPINS):
        return None
    made = _find_node(trace)
    if not made:
        return None
    name, line = made
    return Cause(
        names.EXIT_AT_ONCE,
        f"{ended}: it makes a node in line {line}, but never spins it, and so runs to its end",
        _spin_at_end(trace, name, line) or f"right after line {line}, with the same indentation: rclpy.spin({name})",
    )


def _spin_at_end(trace: Trace, node: str, line: int) -> str | None:
    """The step that spins a node once everything is set up: above the program's cleanup, or at its end."""
    file = started_node(trace)
    made = file.statement_at(line)
    body = file.block_of(made) if made is not None else []
    after = [each for each in body if each.lineno > line]
    cleanup = [each for each in after if source.calls_in(each, *_CLEANUP) or "__name__" in ast.unparse(each)]
    code = f"rclpy.spin({node})"
    if cleanup:
        return file.step([edits.insert_above(cleanup[0].lineno, code)])
    last = body[-1] if body else made
    return file.step([edits.insert_after(last, code)]) if last is not None else None


def _as_spin(call: ast.Call) -> str:
    """Rewrite a call such as spin_once(node, timeout_sec=0.1) as rclpy.spin(node)."""
    spin = f"{ast.unparse(call.func).rpartition('.')[0]}.spin" if isinstance(call.func, ast.Attribute) else "rclpy.spin"
    first = call.args[0] if call.args else None  # of an executor's, it is a time
    positional = ast.unparse(first) if first is not None and not isinstance(first, ast.Constant) else ""
    named = next((ast.unparse(each.value) for each in call.keywords if each.arg == "node"), "")
    return f"{spin}({positional or named})"


def _find_node(trace: Trace) -> tuple[str, int] | None:
    """The name that a node is assigned to where it is created, and the line."""
    classes = [name for file in source.files(trace) for name in file.node_classes]
    found = [each for each in source.assigned(trace, *classes, "Node", "create_node") if each[0]]
    return found[0] if found else None


def _node_name(trace: Trace) -> str:
    made = _find_node(trace)
    return made[0] if made else "node"


def _has_spin(trace: Trace, function: source.Function | None) -> bool:
    """Whether the same function already spins: the program reaches that line once the loop is gone."""
    inside = ast.walk(function) if function is not None else source.all_nodes(trace)
    return any(isinstance(each, ast.Call) and source.called_name(each) == "spin" for each in inside)


def _plain_call(statement: ast.stmt) -> str | None:
    """The function of a statement that only calls it without arguments, so that a timer can call it instead."""
    if isinstance(statement, ast.Expr) and isinstance(call := statement.value, ast.Call):
        return None if call.args or call.keywords else ast.unparse(call.func)
    return None


def _describe_loop(loop: Loop) -> str:
    head = (
        f"while {ast.unparse(loop.test)}" if isinstance(loop, ast.While) else f"for {ast.unparse(loop.target)} in ..."
    )
    return f"line {loop.lineno}: {head}:"
