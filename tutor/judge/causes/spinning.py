"""Why nobody runs a node's callbacks: the line at which the program stays, or ends, and what belongs there."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from tutor.judge import edits, source, tracebacks
from tutor.judge.causes import names
from tutor.judge.rewriting.callbacks import Loop, only_waits, outermost
from tutor.judge.rewriting.node import NodeFile, node_file, started_node
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause

_TIDYING = "destroy_node", "shutdown", "try_shutdown", "exit", "_exit"
_SPINS = "spin", "spin_once", "spin_some", "spin_until_future_complete"


def diagnose_not_spinning(trace: Trace, stuck: Sequence[Frame], nodes: str) -> Cause | None:
    """Where the program stays instead of spinning; `stuck`: where its threads are, `nodes` names the node.

    None where this is not known, or where it does spin.
    """
    mains = [thread for thread in tracebacks.frames_by_thread(stuck) if thread[-1].function == "<module>"]
    at = tracebacks.own_frame(mains[0] if mains else stuck, trace.folder)
    if at is None or "spin" in at.code or any(frame.path.endswith("rclpy/executors.py") for frame in stuck):
        return None
    loop = outermost(_file(trace, at), at.line)
    where = f"at {at}" + (f", in the loop of {_line(loop)}" if loop is not None and loop.lineno != at.line else "")
    return Cause(
        names.NO_SPIN,
        f"{nodes} exists, but answers no request: its callbacks are never run. The program stays {where}",
        _in_place(trace, at, loop),
    )


def _file(trace: Trace, at: Frame) -> NodeFile:
    return node_file(trace.sources.get(at.name, ""), at.name if len(trace.sources) > 1 else "")


def _in_place(trace: Trace, at: Frame, loop: Loop | None) -> str:
    """What is written in place of the line, or the loop, at which the program stays."""
    file = _file(trace, at)
    function = file.function_at(at.line)
    own = function is not None and function.name != "main" and "self" in [each.arg for each in function.args.args[:1]]
    node = "self" if own else _node(trace)
    spin = "" if own or _spun(trace, function) else f"rclpy.spin({node})"
    statement = loop or file.statement_at(at.line)
    if statement is None:
        return f"take line {at.line}, {at.code}, out: what has to wait is done by a timer, while the node spins"
    lines = statement.lineno, statement.end_lineno or statement.lineno
    code = spin
    if loop is not None and (work := [each for each in loop.body if not only_waits(each)]):
        period = next((ast.unparse(nap.args[0]) for nap in source.calls_in(loop, "sleep") if nap.args), "1.0")
        callback, defined = _callback(loop, work, function)
        code = "\n".join([*defined, f"{node}.create_timer({period}, {callback})", *([spin] if spin else [])])
    edit = edits.replace_lines(lines[0], code, lines[1]) if code else edits.remove_lines(file.text, *lines)
    return file.step([edit]) or (
        f"move what lines {lines[0]} to {lines[1]} do, without the sleep, into a callback of a timer, and spin the node"
    )


def _callback(loop: Loop, work: Sequence[ast.stmt], function: source.Function | None) -> tuple[str, list[str]]:
    """The function that does the work of a loop once, and the lines that define it, where it is not there yet."""
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


def diagnose_early_end(trace: Trace, said: str) -> Cause | None:
    """Why a program ends by itself: it never spins, or spins once only. `said`: that it has ended, and how."""
    if not trace.sources or source.calls(trace, "spin"):
        return None
    in_loops = {id(call) for loop in source.all_nodes(trace) if isinstance(loop, Loop) for call in ast.walk(loop)}
    once = source.calls(trace, "spin_once", "spin_some")
    if once and not any(id(call) in in_loops for call in once):
        code = ast.unparse(once[0])
        return Cause(
            names.EXIT_AT_ONCE,
            f"{said}: line {once[0].lineno}, {code}, waits for one piece of work only, and then the program goes on to "
            "its end",
            f"line {once[0].lineno} becomes: {_whole(once[0])}",
        )
    if source.calls(trace, *_SPINS):
        return None
    made = _made(trace)
    if not made:
        return None
    name, line = made
    return Cause(
        names.EXIT_AT_ONCE,
        f"{said}: it makes a node in line {line}, never spins it, and so comes to its end",
        _spinning_at_end(trace, name, line)
        or f"right after line {line}, with the same indentation: rclpy.spin({name})",
    )


def _spinning_at_end(trace: Trace, node: str, line: int) -> str | None:
    """The step where a node is spun once all is set up: before the program tidies up, or at its end."""
    file = started_node(trace)
    made = file.statement_at(line)
    bodies = [body for each in ast.walk(file.tree) if isinstance(body := getattr(each, "body", None), list)]
    body = next(
        (each for each in bodies if any(made is not None and other.lineno == made.lineno for other in each)), []
    )
    after = [each for each in body if each.lineno > line]
    tidying = [each for each in after if source.calls_in(each, *_TIDYING) or "__name__" in ast.unparse(each)]
    code = f"rclpy.spin({node})"
    if tidying:
        return file.step([edits.insert_above(tidying[0].lineno, code)])
    last = body[-1] if body else made
    return file.step([edits.insert_after(last, code)]) if last is not None else None


def _whole(call: ast.Call) -> str:
    """spin_once(node, timeout_sec=0.1) as spin(node)."""
    spun = f"{ast.unparse(call.func).rpartition('.')[0]}.spin" if isinstance(call.func, ast.Attribute) else "rclpy.spin"
    given = ast.unparse(call.args[0]) if call.args and spun == "rclpy.spin" else ""
    named = next((ast.unparse(each.value) for each in call.keywords if each.arg == "node"), "")
    return f"{spun}({given or named})"


def _made(trace: Trace) -> tuple[str, int] | None:
    """What the node is called where it is made, outside of its own class, and the line."""
    classes = [name for file in source.files(trace) for name in file.node_classes]
    found = [each for each in source.assigned(trace, *classes, "Node", "create_node") if each[0]]
    return found[0] if found else None


def _node(trace: Trace) -> str:
    made = _made(trace)
    return made[0] if made else "node"


def _spun(trace: Trace, function: source.Function | None) -> bool:
    """Whether the same function spins already, outside of the loop: that line is reached once the loop is gone."""
    inside = ast.walk(function) if function is not None else source.all_nodes(trace)
    return any(isinstance(each, ast.Call) and source.called_name(each) == "spin" for each in inside)


def _plain_call(statement: ast.stmt) -> str | None:
    """The function of a call without arguments, which a timer can call as well."""
    if isinstance(statement, ast.Expr) and isinstance(call := statement.value, ast.Call):
        return None if call.args or call.keywords else ast.unparse(call.func)
    return None


def _line(loop: Loop) -> str:
    head = (
        f"while {ast.unparse(loop.test)}" if isinstance(loop, ast.While) else f"for {ast.unparse(loop.target)} in ..."
    )
    return f"line {loop.lineno}: {head}:"
