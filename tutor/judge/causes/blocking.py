"""Causes for a node that is up but does not answer (any more): where a callback is blocked, and what it waits for."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from functools import partial

from tutor.judge import source, tracebacks
from tutor.judge.causes import names
from tutor.judge.causes.lock_waits import LOCK_LINE, diagnose_lock, step_at
from tutor.judge.causes.spinning import is_spinning
from tutor.judge.edits import Edit, remove_lines
from tutor.judge.rewriting.callbacks import (
    WITH_CALLBACK_GROUP,
    await_lines,
    make_reentrant,
    outermost,
    remove_loop,
)
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.rewriting.program import first_sound_step, whole_program
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause

_SPIN_UNTIL = re.compile(r"(?:[\w.]+\.)?spin(?:_once)?_until_future_complete\(.*?,\s*(?P<future>[\w.]+)\s*[,)]")
_POLLING_LOOP = re.compile(r"while not (?P<future>[\w.]+)\.done\(\)")
_SPINS = "spin", "spin_once", "spin_until_future_complete"


def diagnose_blocked(trace: Trace, stuck: Sequence[Frame], *, spins: bool = False) -> Cause | None:
    """What blocks a node; None if there is no sign that any callback has run.

    `stuck`: a stack dump of its threads, innermost frame first. `spins`: it has answered a request before.
    """
    if (blocked := _find_blocked_callback(stuck, trace.folder)) is not None:
        return _diagnose_callback(trace, stuck, *blocked)
    if is_in_blocking_call(stuck):
        return _diagnose_call(trace, tracebacks.own_frame(stuck, trace.folder))
    if not spins:
        return _diagnose_await(trace) if is_spinning(stuck) else None
    return (
        _diagnose_nested_spin(trace)
        or _diagnose_await(trace)
        or Cause(
            names.BLOCKED_EXECUTOR,
            "the node is up, but one of its callbacks never returns; all others wait for it",
            "let every callback return at once: no loop and no sleep in it; let a timer do what has to wait",
        )
    )


def is_in_blocking_call(stuck: Sequence[Frame]) -> bool:
    """Whether a thread is waiting in rclpy's blocking `Client.call()`."""
    return any(frame.function == "call" and frame.path.endswith("rclpy/client.py") for frame in stuck)


def diagnose_lock_wait(trace: Trace, stuck: Sequence[Frame]) -> Cause | None:
    """Whether a callback waits for a lock."""
    blocked = _find_blocked_callback(stuck, trace.folder)
    if blocked is None or not LOCK_LINE.search(blocked[0].code):
        return None
    return diagnose_lock(trace, stuck, blocked[0])


def _find_blocked_callback(stuck: Sequence[Frame], folder: str) -> tuple[Frame, tuple[Frame, ...]] | None:
    """The learner's innermost frame in a running callback, and the frames that it has called.

    A callback that waits for another one takes precedence over one that is busy.
    """
    found = []
    for thread in tracebacks.frames_by_thread(stuck):
        if tracebacks.called_by_executor(thread, folder):
            own = next(i for i, frame in enumerate(thread) if tracebacks.is_in_folder(frame.path, folder))
            found.append((thread[own], thread[:own]))
    return min(
        found, key=lambda each: not (is_in_blocking_call(each[1]) or LOCK_LINE.search(each[0].code)), default=None
    )


def _diagnose_callback(trace: Trace, stuck: Sequence[Frame], at: Frame, inner: Sequence[Frame]) -> Cause:
    if is_in_blocking_call(inner):
        return _diagnose_call(trace, at)
    if any(frame.path.endswith(("rclpy/executors.py", "rclpy/__init__.py")) for frame in inner):
        return _diagnose_spin_in_callback(trace, at)
    if LOCK_LINE.search(at.code):
        return diagnose_lock(trace, stuck, at)
    if (future := _find_polled_future(trace, at)) is not None:
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"the callback waits in a loop, at {at}, for an answer that cannot come: the executor is busy with this "
            "callback",
            step_at(trace, at, partial(_await_instead_of_loop, at=at, code=f"await {future}"))
            or f"write await {future} in place of the loop, {_as_coroutine(trace, at)}; {use_reentrant_group(trace)}",
        )
    waits = any(frame.path.endswith("/threading.py") for frame in inner) or ".wait(" in at.code
    if waits:
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"a callback waits, at {at}, for something that only another callback could provide, and that one cannot "
            "run meanwhile",
            first_sound_step(trace, _run_concurrently)
            or f"let callbacks run concurrently: {use_threads(trace)}; {use_reentrant_group(trace)}",
        )
    loop = "let it do one iteration and return; a timer calls it again" if at.code.startswith(("while", "for")) else ""
    return Cause(
        names.BLOCKED_EXECUTOR,
        f"the node is up, but one of its callbacks never returns, at {at}; all others wait for it",
        step_at(trace, at, lambda file: remove_loop(file, at.line))
        or f"look at line {at.line}: {loop or 'let the callback return at once, without a loop or a sleep around it'}; "
        "what has to wait, or to come again and again, is done by a timer: self.create_timer(period, self.callback)",
    )


def _diagnose_call(trace: Trace, at: Frame | None) -> Cause:
    where = f", at {at}" if at else ""
    multi_threaded = source.mentions(trace, "MultiThreadedExecutor")
    becomes = ""
    edited = None
    if at is not None and ".call(" in at.code:
        code = _await_call(at.code)
        becomes = f"line {at.line} becomes: {code} ({_as_coroutine(trace, at)}); "
        edited = step_at(trace, at, lambda file: await_lines(file, at.line, code))
    return Cause(
        names.DEADLOCK,
        f"the callback waits for another service's answer{where}, which cannot come: the executor is busy with this "
        "callback",
        edited
        or ("" if multi_threaded else becomes or "use await client.call_async(request), in an async def; ")
        + use_reentrant_group(trace),
    )


def _await_call(code: str) -> str:
    """Replace `client.call(request)` in a line by `await client.call_async(request)`."""
    found = re.search(r"((?:\w+\.)*\w+)\.call\(", code)
    assert found is not None
    depth, end = 1, found.end()
    while depth and end < len(code):
        depth += {"(": 1, ")": -1}.get(code[end], 0)
        end += 1
    call = f"await {found[1]}.call_async({code[found.end() : end]}"
    return code[: found.start()] + (f"({call})" if code[end:].startswith(".") else call) + code[end:]


def _diagnose_spin_in_callback(trace: Trace, at: Frame) -> Cause:
    future = _SPIN_UNTIL.search(at.code)
    instead = (
        f"line {at.line} becomes: await {future['future']} ({_as_coroutine(trace, at)}); {use_reentrant_group(trace)}"
        if future
        else f"delete line {at.line}: main() already spins the node, and that is what runs this callback"
    )
    edits = partial(_await_instead_of_spin, line=at.line, future=future["future"] if future else "")
    return Cause(
        names.BLOCKED_EXECUTOR,
        f"a callback spins the node again, at {at}, and waits there for something that cannot happen before this "
        "callback returns",
        step_at(trace, at, edits) or instead,
    )


def _diagnose_nested_spin(trace: Trace) -> Cause | None:
    """Whether a method of the node spins the node, which takes it away from the executor that runs it."""
    for call in source.calls(trace, *_SPINS):
        first = ast.unparse(call.args[0]) if call.args else ""
        if first != "self":
            continue
        code = ast.unparse(call)
        future = _SPIN_UNTIL.search(code)
        becomes = (
            f"await {future['future']}, in an async def; {use_reentrant_group(trace)}"
            if future
            else "nothing: delete it"
        )
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"line {call.lineno}, {code}, spins the node within one of its own callbacks, which takes it away from the "
            "executor that runs it: from then on, no callback is called any more",
            first_sound_step(
                trace,
                partial(_await_instead_of_spin, line=call.lineno, future=future["future"] if future else ""),
            )
            or f"line {call.lineno} becomes {becomes}",
        )
    return None


def _diagnose_await(trace: Trace) -> Cause | None:
    """Whether a callback awaits something, which frees the executor but not the callback's group."""
    awaited = sorted(
        (each for each in source.all_nodes(trace) if isinstance(each, ast.Await)), key=lambda each: each.lineno
    )
    if not awaited:
        return None
    at = awaited[0]
    return Cause(
        "deadlock by await",
        f"a callback awaits something that never comes, at line {at.lineno}: {ast.unparse(at)}. While it waits, "
        "nothing else in its callback group runs, and the answer would arrive in that group",
        first_sound_step(trace, make_reentrant) or use_reentrant_group(trace),
    )


def _await_instead_of_loop(file: NodeFile, at: Frame, code: str) -> list[Edit]:
    loop = outermost(file, at.line)
    return await_lines(file, loop.lineno, code, loop.end_lineno or 0) if loop is not None else []


def _run_concurrently(file: NodeFile) -> list[Edit]:
    return [*whole_program(file, threads=True), *make_reentrant(file)]


def _await_instead_of_spin(file: NodeFile, line: int, future: str) -> list[Edit]:
    return await_lines(file, line, f"await {future}") if future else [remove_lines(file.text, line)]


def _find_polled_future(trace: Trace, at: Frame) -> str | None:
    """The future that the loop around this line polls."""
    lines = trace.sources.get(at.name, "").splitlines()[: at.line]
    for line in [at.code, *reversed(lines[-6:])]:
        if found := _POLLING_LOOP.search(line):
            return found["future"]
    return None


def _as_coroutine(trace: Trace, at: Frame) -> str:
    """How to turn the function that contains this line into a coroutine."""
    if any(isinstance(each, ast.AsyncFunctionDef) and each.name == at.function for each in source.all_nodes(trace)):
        return f"{at.function} is already async def"
    return f"with async in front of def {at.function}(...)"


def use_threads(trace: Trace) -> str:
    """How to run the callbacks in several threads, as far as the source does not do so yet."""
    spins = [call for call in source.calls(trace, "spin") if ast.unparse(call.func) == "rclpy.spin"]
    made = source.assigned(trace, "MultiThreadedExecutor")
    place = f"in place of line {spins[0].lineno}, {ast.unparse(spins[0])}" if spins else "in main()"
    if made and spins and made[0][0]:
        return f"write {made[0][0]}.spin() {place}"
    if made:
        return f"give the MultiThreadedExecutor, line {made[0][1]}, num_threads=4"
    node = ast.unparse(spins[0].args[0]) if spins and spins[0].args else "node"
    return (
        f"write {place}: executor = MultiThreadedExecutor(num_threads=4); executor.add_node({node}); executor.spin(), "
        "with from rclpy.executors import MultiThreadedExecutor at the top"
    )


def use_reentrant_group(trace: Trace) -> str:
    """How to put everything into one reentrant callback group, as far as the source does not do so yet."""
    exclusive = source.calls(trace, "MutuallyExclusiveCallbackGroup")
    made = source.calls(trace, *WITH_CALLBACK_GROUP)
    without = [call.lineno for call in made if not any(each.arg == "callback_group" for each in call.keywords)]
    steps = []
    if exclusive:
        lines = _lines([call.lineno for call in exclusive])
        steps.append(f"write ReentrantCallbackGroup() in place of MutuallyExclusiveCallbackGroup() in {lines}")
    if without or not made:
        where = _lines(without) if without else "every create_client(...) and create_service(...)"
        steps.append(
            f"give {where} callback_group=self.group, with self.group = ReentrantCallbackGroup() above them and from "
            "rclpy.callback_groups import ReentrantCallbackGroup at the top"
        )
    if not steps:
        return "do not call a service of this node from its own callbacks: do the work in the callback itself"
    return "\n".join(steps)


def _lines(numbers: Sequence[int]) -> str:
    return f"line {numbers[0]}" if len(numbers) == 1 else f"lines {', '.join(map(str, numbers))}"
