"""Loops of a program that does the work of a timer itself."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.themes.spinning import publishes
from tutor.source import NodeFile, calls_in


@mistake(
    "sleeps-instead-of-a-timer",
    explains=(Symptom.WRONG_RATE,),
    says="{line} sets the pace of the messages, with the time of the work between them on top: {code}",
    do="Let a timer publish in place of the loop, with the period that is asked for.",
    remark="this sleep sets the pace of the messages, with the time of the work on top. A timer keeps the rate.",
)
def sleeps(case: Case) -> Iterator[Found]:
    """A loop with a sleep publishes, where a timer could.

    A sleep begins when the work of one turn is done, so a turn lasts as long as both together, and the rate falls with
    the work. A timer counts from tick to tick, and lets the node answer requests in between.

    Bad:

        def work(self):
            while True:
                self.blinker.publish(Bool(data=self.is_on))
                time.sleep(0.5)

    Good:

        def __init__(self):
            super().__init__('blinker')
            self.create_timer(0.5, self.blink)

    See it: `ros2 topic hz TOPIC`, with some work in the loop.
    """
    for file in case.files if not case.program.calls("create_timer") else ():
        for loop in (node for node in file.nodes if isinstance(node, ast.While)):
            if isinstance(loop.test, ast.Constant) and loop.test.value and publishes(file, loop):
                yield from (found(file, nap) for nap in _naps(file, loop)[:1])


def _naps(file: NodeFile, loop: ast.While) -> list[ast.Call]:
    """The sleeps of a loop, but for those that take the time of the work into account: `sleep(due - now)`."""
    inside = [call for call in calls_in(loop, "sleep") if file.function_around(call) is file.function_around(loop)]
    plain = [call for call in inside if ast.unparse(call.func) in ("time.sleep", "sleep") and call.args]
    return [call for call in plain if all(not isinstance(node, ast.Sub | ast.Call) for node in ast.walk(call.args[0]))]
