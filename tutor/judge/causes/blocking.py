"""Causes of a node that is up and no longer answers: where a callback is held up, and what it waits for."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Sequence
from functools import partial

from tutor.judge import source, tracebacks
from tutor.judge.causes import names
from tutor.judge.edits import Edit, remove_lines
from tutor.judge.rewriting.callbacks import (
    await_lines,
    make_lock_reentrant,
    make_reentrant,
    outermost,
    remove_lock,
    remove_loop,
)
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.rewriting.program import first_sound_step, whole_program
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause

_LOCK = re.compile(
    r"(?P<lock>[\w.]+)\.acquire\(|with (?P<with>[\w.]*(?:lock|mutex|semaphore|condition)\w*)", re.IGNORECASE
)
_SPIN = re.compile(r"(?:[\w.]+\.)?spin(?:_once)?_until_future_complete\(.*?,\s*(?P<future>[\w.]+)\s*[,)]")
_POLLS = re.compile(r"while not (?P<future>[\w.]+)\.done\(\)")
_MADE = "create_client", "create_service", "create_timer", "create_subscription"
_SPINS = "spin", "spin_once", "spin_until_future_complete"


def diagnose_blocked(trace: Trace, stuck: Sequence[Frame], *, spins: bool = False) -> Cause | None:
    """What holds a node up. None where nothing tells that any callback has been run.

    `stuck`: where its threads are, innermost frame first. `spins`: it has answered a request before.
    """
    if (held := _held(stuck, trace.folder)) is not None:
        return _diagnose_callback(trace, stuck, *held)
    if is_in_blocking_call(stuck):
        return _diagnose_call(trace, tracebacks.own_frame(stuck, trace.folder))
    if not spins:
        return None
    return (
        _diagnose_taken_away(trace)
        or _diagnose_awaiting(trace)
        or Cause(
            names.BLOCKED_EXECUTOR,
            "the node is up, but one of its callbacks never returns; all others wait for it",
            "let every callback return at once: no loop and no sleep in it; let a timer do what has to wait",
        )
    )


def is_in_blocking_call(stuck: Sequence[Frame]) -> bool:
    """Whether a thread waits in rclpy's blocking `Client.call()`."""
    return any(frame.function == "call" and frame.path.endswith("rclpy/client.py") for frame in stuck)


def diagnose_lock_wait(trace: Trace, stuck: Sequence[Frame]) -> Cause | None:
    """Whether one callback waits for a lock."""
    held = _held(stuck, trace.folder)
    return _diagnose_lock(trace, stuck, held[0]) if held is not None and _LOCK.search(held[0].code) else None


def _held(stuck: Sequence[Frame], folder: str) -> tuple[Frame, tuple[Frame, ...]] | None:
    """Where a callback is: the learner's innermost line, and the frames of its thread that are within it.

    A callback that waits for another one comes before one that is at work.
    """
    found = []
    for thread in tracebacks.frames_by_thread(stuck):
        if tracebacks.called_by_executor(thread, folder):
            mine = next(i for i, frame in enumerate(thread) if tracebacks.is_in_folder(frame.path, folder))
            found.append((thread[mine], thread[:mine]))
    return min(found, key=lambda each: not (is_in_blocking_call(each[1]) or _LOCK.search(each[0].code)), default=None)


def _diagnose_callback(trace: Trace, stuck: Sequence[Frame], at: Frame, inner: Sequence[Frame]) -> Cause:
    if is_in_blocking_call(inner):
        return _diagnose_call(trace, at)
    if any(frame.path.endswith(("rclpy/executors.py", "rclpy/__init__.py")) for frame in inner):
        return _diagnose_spinning(trace, at)
    if _LOCK.search(at.code):
        return _diagnose_lock(trace, stuck, at)
    if (polled := _polled(trace, at)) is not None:
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"the callback waits in a loop for the answer, at {at}, which cannot come: the executor is busy with it",
            _edited(trace, at, partial(_in_loop, at=at, code=f"await {polled}"))
            or f"write await {polled} in place of the loop, {_as_coroutine(trace, at)}; {use_reentrant_group(trace)}",
        )
    waits = any(frame.path.endswith("/threading.py") for frame in inner) or ".wait(" in at.code
    if waits:
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"a callback waits, at {at}, for what only another callback could bring; that one is never run meanwhile",
            first_sound_step(trace, _in_threads)
            or f"let several be run at once: {use_threads(trace)}; {use_reentrant_group(trace)}",
        )
    loop = "let it do one round and return; a timer calls it again" if at.code.startswith(("while", "for")) else ""
    return Cause(
        names.BLOCKED_EXECUTOR,
        f"the node is up, but one of its callbacks never returns, at {at}; all others wait for it",
        _edited(trace, at, lambda file: remove_loop(file, at.line))
        or f"look at line {at.line}: {loop or 'let the callback return at once, without a loop or a sleep around it'}; "
        "what has to wait, or to come again and again, is done by a timer: self.create_timer(period, self.callback)",
    )


def _diagnose_call(trace: Trace, at: Frame | None) -> Cause:
    where = f", at {at}" if at else ""
    several = source.mentions(trace, "MultiThreadedExecutor")
    becomes = ""
    if at is not None and ".call(" in at.code:
        becomes = f"line {at.line} becomes: {_awaited(at.code)} ({_as_coroutine(trace, at)}); "
    edited = None
    if at is not None and ".call(" in at.code:
        edited = _edited(trace, at, lambda file: await_lines(file, at.line, _awaited(at.code)))
    return Cause(
        names.DEADLOCK,
        f"the callback waits for another service's answer{where}, which cannot come: the executor is busy with this "
        "callback",
        edited
        or ("" if several else becomes or "use await client.call_async(request), in an async def; ")
        + use_reentrant_group(trace),
    )


def _awaited(code: str) -> str:
    """A line with `client.call(request)`, with `await client.call_async(request)` in its place."""
    found = re.search(r"((?:\w+\.)*\w+)\.call\(", code)
    assert found is not None
    depth, end = 1, found.end()
    while depth and end < len(code):
        depth += {"(": 1, ")": -1}.get(code[end], 0)
        end += 1
    call = f"await {found[1]}.call_async({code[found.end() : end]}"
    return code[: found.start()] + (f"({call})" if code[end:].startswith(".") else call) + code[end:]


def _diagnose_spinning(trace: Trace, at: Frame) -> Cause:
    future = _SPIN.search(at.code)
    instead = (
        f"line {at.line} becomes: await {future['future']} ({_as_coroutine(trace, at)}); {use_reentrant_group(trace)}"
        if future
        else f"delete line {at.line}: main() spins the node already, and it is what runs this callback"
    )

    def edits(file: NodeFile) -> list[Edit]:
        return await_lines(file, at.line, f"await {future['future']}") if future else [remove_lines(file.text, at.line)]

    return Cause(
        names.BLOCKED_EXECUTOR,
        f"a callback spins the node again, at {at}, and waits there for what only the end of this callback would let "
        "through",
        _edited(trace, at, edits) or instead,
    )


def _diagnose_lock(trace: Trace, stuck: Sequence[Frame], at: Frame) -> Cause:
    found = _LOCK.search(at.code)
    lock = (found["lock"] or found["with"]) if found else "the lock"
    made = next((call for call in source.calls(trace, "Lock") if call.lineno), None)
    holders = [
        frame
        for thread in tracebacks.frames_by_thread(stuck)
        if (frame := tracebacks.own_frame(thread, trace.folder)) is not None
        and tracebacks.called_by_executor(thread, trace.folder)
        and not _LOCK.search(frame.code)
    ]
    if holders:
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"a callback waits for {lock}, at {at}, which another one holds at {holders[0]}",
            _edited(trace, holders[0], lambda file: remove_lock(file, holders[0].line))
            or f"take line {holders[0].line} out of the lock: what takes long goes above `with {lock}:`, or below it, "
            "with less indentation",
        )
    where = f" in line {made.lineno}" if made else ""
    return Cause(
        names.BLOCKED_EXECUTOR,
        f"a callback waits for {lock}, at {at}, forever: it is held already, by the same callback or by one that did "
        "not release it",
        _edited(trace, at, make_lock_reentrant)
        or f"write threading.RLock() in place of threading.Lock(){where}: one thread may take it twice; and with "
        f"{lock}: in place of acquire() and release()",
    )


def _diagnose_taken_away(trace: Trace) -> Cause | None:
    """Whether a method of the node spins the node: that takes it away from the executor that runs it."""
    for call in source.calls(trace, *_SPINS):
        first = ast.unparse(call.args[0]) if call.args else ""
        if first != "self":
            continue
        code = ast.unparse(call)
        future = _SPIN.search(code)
        becomes = (
            f"await {future['future']}, in an async def; {use_reentrant_group(trace)}"
            if future
            else "nothing: delete it"
        )
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"line {call.lineno}, {code}, spins the node within one of its own callbacks, which takes it away from the "
            "executor that runs it: from then on, no callback is called any more",
            first_sound_step(trace, partial(_taken_back, line=call.lineno, future=future["future"] if future else ""))
            or f"line {call.lineno} becomes {becomes}",
        )
    return None


def _diagnose_awaiting(trace: Trace) -> Cause | None:
    """Whether a callback awaits something: the executor is free then, and the callback's group is not."""
    awaited = sorted(
        (each for each in source.all_nodes(trace) if isinstance(each, ast.Await)), key=lambda each: each.lineno
    )
    if not awaited:
        return None
    at = awaited[0]
    return Cause(
        "deadlock by await",
        f"a callback awaits what never comes, at line {at.lineno}: {ast.unparse(at)}. As long as it waits, nothing "
        "else in its callback group is run, and that is where the answer comes in",
        first_sound_step(trace, make_reentrant) or use_reentrant_group(trace),
    )


def _edited(trace: Trace, at: Frame, edits: Callable[[NodeFile], Sequence[Edit]]) -> str | None:
    """The step in the file of a frame, where that is the file that was run."""
    text = trace.sources.get(at.name, "").splitlines()
    there = 0 < at.line <= len(text) and text[at.line - 1].strip() == at.code
    return first_sound_step(trace, edits, name=at.name) if there else None


def _in_loop(file: NodeFile, at: Frame, code: str) -> list[Edit]:
    loop = outermost(file, at.line)
    return await_lines(file, loop.lineno, code, loop.end_lineno or 0) if loop is not None else []


def _in_threads(file: NodeFile) -> list[Edit]:
    return [*whole_program(file, threads=True), *make_reentrant(file)]


def _taken_back(file: NodeFile, line: int, future: str) -> list[Edit]:
    return await_lines(file, line, f"await {future}") if future else [remove_lines(file.text, line)]


def _polled(trace: Trace, at: Frame) -> str | None:
    """The future that the loop around this line waits for."""
    lines = trace.sources.get(at.name, "").splitlines()[: at.line]
    for line in [at.code, *reversed(lines[-6:])]:
        if found := _POLLS.search(line):
            return found["future"]
    return None


def _as_coroutine(trace: Trace, at: Frame) -> str:
    """How the function that this line is in becomes one that may await."""
    if any(isinstance(each, ast.AsyncFunctionDef) and each.name == at.function for each in source.all_nodes(trace)):
        return f"{at.function} is async def already"
    return f"with async in front of def {at.function}(...)"


def use_threads(trace: Trace) -> str:
    """How the callbacks are run by several threads, as far as the source does not do so."""
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
    """How everything comes into one reentrant group, as far as it is not in one."""
    exclusive = source.calls(trace, "MutuallyExclusiveCallbackGroup")
    made = source.calls(trace, *_MADE)
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
