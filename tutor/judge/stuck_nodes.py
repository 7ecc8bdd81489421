"""Nodes that do not answer: another start shows whether they wait for ever, so that nobody waits for them as long."""

from __future__ import annotations

import ast
import asyncio
from collections.abc import Awaitable, Callable, Sequence
from math import inf
from typing import Self

from tutor.judge import tracebacks
from tutor.judge.bench import Run
from tutor.judge.tasks import Tasks
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.ros_model import Parameter
from tutor.source import Function, Loop, Program, called_name, last_name, only_waits

SLOW_ANSWER_S = 0.5
"""A spinning node answers within this time, unless the machine is busy."""

_UNTIL_SIGINT = "True", "1", "rclpy.ok()", "ok()"
"""Conditions that hold until Ctrl+C."""
_QUERIES = "done", "is_set", "ok", "len"
"""Functions that do nothing but say how things are."""

_PLAIN = ast.Constant, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.unaryop, ast.boolop, ast.cmpop, ast.expr_context

Look = Callable[[], Awaitable[tuple[Frame, ...]]]
"""Returns the stack of another start that is given no more than the run is."""


class StuckTest:
    """Tells whether a run waits for ever, by the stack of another start. Leaving its context ends that start."""

    def __init__(self, run: Run, look: Look) -> None:
        self._run = run
        self._look = look
        self._looking: asyncio.Future[bool] | None = None

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        if self._looking is not None:
            self._looking.cancel()
            await asyncio.gather(self._looking, return_exceptions=True)

    def start(self) -> None:
        """Look at another start, unless that has already been asked for."""
        if self._looking is None and self._run.exit is None:
            self._looking = asyncio.ensure_future(self._find_out())

    def is_stuck(self) -> bool:
        """Whether the other start has shown by now that the run will do nothing more by itself."""
        looking = self._looking
        return looking is not None and looking.done() and looking.exception() is None and looking.result()

    async def _find_out(self) -> bool:
        return is_stuck_for_ever(self._run, await self._look())


def is_stuck_for_ever(run: Run, frames: Sequence[Frame]) -> bool:
    """Whether a run will do nothing more by itself, given the stack of another start: no process of it can."""
    return len(run.command_lines()) == 1 and waits_for_ever(run.trace(), frames)


async def ask_unless_stuck(run: Run, limit_s: float, look: Look) -> tuple[tuple[Parameter, ...] | None, bool]:
    """Ask a node for its parameters; return its answer, None if there is none, and whether the node waits for ever.

    `look` is called if the answer takes longer than that of a spinning node, and the answer is not waited for once the
    stack shows that none will come.
    """
    async with Tasks() as tasks, StuckTest(run, look) as test:
        asked = tasks.start(run.parameters(limit_s))
        if not await run.until(asked.done, SLOW_ANSWER_S):
            test.start()
        await run.until(lambda: asked.done() or test.is_stuck(), inf)
        return (None, True) if test.is_stuck() else (await asked, False)


def waits_for_ever(trace: Trace, stuck: Sequence[Frame]) -> bool:
    """Whether every thread of a stack dump is in a loop of the learner's that only waits, and that nothing ends.

    Only a signal could do something then, such as one that the program asks for with an alarm.
    """
    program = Program(trace.sources, trace.file)
    if program.mentions("alarm", "setitimer"):
        return False
    threads = tracebacks.frames_by_thread(stuck)
    own = [tracebacks.own_frame(thread, trace.folder) for thread in threads]
    return bool(own) and all(at is not None and _is_in_waiting_loop(program, at, len(threads) == 1) for at in own)


def _is_in_waiting_loop(program: Program, at: Frame, alone: bool) -> bool:
    """`alone`: no other thread can change what the loop waits for."""
    file = program.named(at.name)
    inside = [file.statement_at(at.line), *file.ancestors(file.statement_at(at.line) or file.tree)]
    loop = next((node for node in inside if isinstance(node, Loop)), None)
    if not isinstance(loop, ast.While) or file.function_around(loop) is not file.function_at(at.line):
        return False
    endless = ast.unparse(loop.test) in _UNTIL_SIGINT or (alone and _only_looks(program, loop.test))
    return endless and all(map(only_waits, loop.body))


def _only_looks(program: Program, test: ast.expr) -> bool:
    """Whether evaluating a condition runs no code of the learner's, and asks no clock: only others can change it."""
    own = {node.name for node in program.nodes() if isinstance(node, Function)}
    if any(name.startswith("__") and name != "__init__" for name in own):  # such as __bool__ or __eq__
        return False
    for part in ast.walk(test):
        if isinstance(part, ast.Call):
            if called_name(part) not in _QUERIES:
                return False
        elif isinstance(part, ast.Name | ast.Attribute):
            if last_name(part) in own:  # perhaps a property
                return False
        elif not isinstance(part, _PLAIN):
            return False
    return True
