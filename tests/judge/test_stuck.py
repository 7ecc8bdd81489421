"""How long to wait for the answer of a node that may never answer."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from tests.checks.builders import FOLDER, trace
from tutor.judge.stuck import SLOW_ANSWER_S, ask_unless_stuck
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.ros_model import Parameter

ANSWER = (Parameter("/node", "rate", "double", 1.0),)
SOURCE = "while True:\n    time.sleep(0.1)\nnode.spin()\n"
WAITING = (Frame(f"{FOLDER}/node.py", 2, "<module>", "time.sleep(0.1)", 1),)
SPINNING = (Frame(f"{FOLDER}/node.py", 3, "<module>", "node.spin()", 1),)


class FakeRun:
    """A run of a node that answers after a number of turns of the event loop, or never."""

    exit = None

    def __init__(self, answers_after: int | None, *, processes: int = 1) -> None:
        self._answers_after, self._processes = answers_after, processes

    async def parameters(self, limit_s: float) -> tuple[Parameter, ...] | None:
        for _ in range(200 if self._answers_after is None else self._answers_after):
            await asyncio.sleep(0)
        return None if self._answers_after is None else ANSWER

    async def until(self, seen: Callable[[], bool], limit_s: float) -> bool:
        turns = 10 if limit_s == SLOW_ANSWER_S else 1000
        while not seen() and turns:
            turns -= 1
            await asyncio.sleep(0)
        return seen()

    def command_lines(self) -> tuple[str, ...]:
        return ("python node.py",) * self._processes

    def trace(self) -> Trace:
        return trace(sources={"node.py": SOURCE})


@pytest.mark.parametrize(
    ("run", "frames", "looks", "answer", "is_stuck"),
    [
        (FakeRun(2), WAITING, 0, ANSWER, False),
        (FakeRun(50), SPINNING, 1, ANSWER, False),
        (FakeRun(None), WAITING, 1, None, True),
        (FakeRun(None), SPINNING, 1, None, False),
        (FakeRun(None), (), 1, None, False),
        (FakeRun(None, processes=2), WAITING, 1, None, False),  # another process may answer
    ],
)
async def test_an_answer_is_awaited_unless_the_stack_shows_that_none_will_come(
    run: FakeRun,
    frames: tuple[Frame, ...],
    looks: int,
    answer: tuple[Parameter, ...] | None,
    is_stuck: bool,
) -> None:
    looked = 0

    async def look() -> tuple[Frame, ...]:
        nonlocal looked
        looked += 1
        return frames

    assert await ask_unless_stuck(run, 2.0, look) == (answer, is_stuck)  # type: ignore[arg-type]
    assert looked == looks


async def test_a_machine_too_busy_for_another_start_leaves_the_answer_to_be_awaited() -> None:
    async def look() -> tuple[Frame, ...]:
        raise TimeoutError

    assert await ask_unless_stuck(FakeRun(50), 2.0, look) == (ANSWER, False)  # type: ignore[arg-type]
