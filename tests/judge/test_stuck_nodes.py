"""How long to wait for the answer of a node that may never answer."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import replace

import pytest

from tests.checks.builders import FOLDER, trace
from tutor.judge.stuck_nodes import SLOW_ANSWER_S, ask_unless_stuck, waits_for_ever
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


PROGRAM = """\
class Client(Node):
    @property
    def expired(self):
        return time.time() > self.end

{definition}

def main():
    client = Client()
    {loop}
        {body}
"""
OTHER_THREAD = Frame("/usr/lib/python3.12/threading.py", 331, "wait", "", 2)


@pytest.mark.parametrize(
    ("loop", "body", "others", "for_ever"),
    [
        ("while rclpy.ok():", "time.sleep(0.1)", (), True),
        ("while True:", "time.sleep(1)", (), True),
        ("while True:", "pass", (), True),
        ("while rclpy.ok():", "client.tick()", (), False),
        ("for _ in range(99):", "time.sleep(0.1)", (), False),
        ("while True:", "time.sleep(0.1); signal.alarm(9)", (), False),
        ("while rclpy.ok():", "time.sleep(0.1)", (OTHER_THREAD,), False),
        (
            "while rclpy.ok():",
            "time.sleep(0.1)",
            (replace(OTHER_THREAD, path=f"{FOLDER}/node.py", line=4, function="expired"),),
            False,
        ),
        # Without another thread, nothing changes these.
        ("while not future.done():", "pass", (), True),
        ("while rclpy.ok() and not future.done():", "time.sleep(0.1)", (), True),
        ("while client.answers < 4:", "time.sleep(0.1)", (), True),
        ("while len(client.answers) != 4:", "time.sleep(0.1)", (), True),
        ("while not future.done():", "time.sleep(0.1)", (OTHER_THREAD,), False),
        ("while not future.done():", "rclpy.spin_once(client)", (), False),
        ("while not client.expired:", "time.sleep(0.1)", (), False),
        ("while time.time() < end:", "time.sleep(0.1)", (), False),
        ("while not client.service_is_ready():", "time.sleep(0.1)", (), False),
        ("while [each for each in client.answers]:", "time.sleep(0.1)", (), False),
    ],
)
def test_only_threads_that_all_wait_in_loops_which_nothing_ends_wait_for_ever(
    loop: str, body: str, others: tuple[Frame, ...], for_ever: bool
) -> None:
    text = PROGRAM.format(definition="", loop=loop, body=body)
    stuck = Frame(f"{FOLDER}/node.py", 10, "main", body, 1), *others
    assert waits_for_ever(trace(sources={"node.py": text}), stuck) == for_ever
    assert not waits_for_ever(trace(sources={"node.py": text}), ())


def test_a_condition_may_run_code_of_the_learners() -> None:
    own = "def done():\n    return poll()"
    for definition, for_ever in (("", True), (own, False), (own.replace("done", "__bool__"), False)):
        text = PROGRAM.format(definition=definition, loop="while not future.done():", body="pass")
        line = 11 if definition else 10
        stuck = (Frame(f"{FOLDER}/node.py", line, "main", "pass", 1),)
        assert waits_for_ever(trace(sources={"node.py": text}), stuck) == for_ever
