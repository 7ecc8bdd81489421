"""Clocks that do not tell how much time has passed."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake

_CPU_CLOCKS = ("process_time", "process_time_ns", "thread_time", "thread_time_ns")


@mistake(
    "wrong-clock",
    explains=[Symptom.WRONG_RATE, Symptom.WRONG_LOG],
    says="{line} reads {what}: {code}",
    do="Take the time from a clock that runs on evenly, such as the node's own or time.monotonic().",
)
def wrong_clock(case: Case) -> Iterator[Found]:
    """A duration is measured with a clock that does not measure it.

    time.process_time() stands still while the program waits, and a node waits nearly always. The nanosec field of a
    stamp is only the fraction of its second: it starts again from 0 with every new one, and sec counts on.

    Bad:

        began = time.process_time()
        open_the_gate()
        seconds = time.process_time() - began

    Good:

        began = time.monotonic()
        open_the_gate()
        seconds = time.monotonic() - began

    See it: measure a sleep of one second.
    """
    if "rate" not in case.about("fault", "rate"):
        return
    for file in case.files:
        for call in file.calls(*_CPU_CLOCKS):
            yield found(file, call, what="the CPU time that the program uses, not the time that passes")
        fields = [node for node in file.nodes if isinstance(node, ast.Attribute)]
        if not any(node.attr == "sec" for node in fields):
            for node in fields:
                if node.attr == "nanosec":
                    yield found(file, node, what="only the fraction of a second, which starts again from 0 each second")
