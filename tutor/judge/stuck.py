"""Nodes that do not answer: another start shows whether they wait for ever, so that nobody waits for them as long."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from math import inf

from tutor.judge.bench import Run
from tutor.judge.causes.spinning import waits_for_ever
from tutor.judge.tracebacks import Frame
from tutor.ros_model import Parameter

SLOW_ANSWER_S = 0.5
"""A spinning node answers within this time, unless the machine is busy."""


def is_stuck_for_ever(run: Run, frames: Sequence[Frame]) -> bool:
    """Whether a run will do nothing more by itself, given the stack of another start: no process of it can."""
    return len(run.command_lines()) == 1 and waits_for_ever(run.trace(), frames)


async def ask_unless_stuck(
    run: Run, limit_s: float, look: Callable[[], Awaitable[tuple[Frame, ...]]]
) -> tuple[tuple[Parameter, ...] | None, bool]:
    """Ask a node for its parameters; return its answer, None if there is none, and whether the node waits for ever.

    `look`: returns the stack of another start that is given no answer either. It is called if the answer takes longer
    than that of a spinning node, and the answer is not waited for once this stack shows that none will come.
    """
    asked = asyncio.ensure_future(run.parameters(limit_s))
    looking: asyncio.Future[tuple[Frame, ...]] = asyncio.get_running_loop().create_future()

    def is_stuck() -> bool:
        found = looking.done() and looking.exception() is None
        return found and is_stuck_for_ever(run, looking.result())

    try:
        if not await run.until(asked.done, SLOW_ANSWER_S) and run.exit is None:
            looking = asyncio.ensure_future(look())
        await run.until(lambda: asked.done() or is_stuck(), inf)
        return (None, True) if is_stuck() else (await asked, False)
    finally:
        looking.cancel()
        asked.cancel()
        await asyncio.gather(looking, asked, return_exceptions=True)
