"""Observations for the examples of pages whose mistake shows only in a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Exit, LogRecord, OutputLine, Trace
from tutor.judge.tracebacks import Frame
from tutor.ros_model import Graph


def in_run(
    symptom: Symptom,
    *,
    graph: Graph | None = None,
    output: Sequence[str] = (),
    logs: Sequence[str] = (),
    exit: Exit | None = None,
    stuck_at: Callable[[str], Sequence[Frame]] | None = None,
    answers: bool = True,
    files: Mapping[str, str] | None = None,
    **about: Any,
) -> Callable[[str], Observation]:
    """A function that makes, of an example's source, the observation in which its mistake is found.

    `output`: lines on stderr. `logs`: texts logged at the level INFO. `stuck_at`: the stack dump of a node with this
    source. `files`: the texts of others beside it. The example is the file "node.py" in the folder "/ws".
    """

    def observe(source: str) -> Observation:
        trace = Trace(
            "node.py",
            "/ws",
            sources={"node.py": source, **(files or {})},
            graph=graph or Graph(("/node",)),
            output=tuple(OutputLine("stderr", line, 0.0) for line in output),
            logs=tuple(LogRecord(20, "node", text, 0.0, 0.0) for text in logs),
            exit=exit,
        )
        stuck = tuple(stuck_at(source)) if stuck_at is not None else ()
        return symptom.seen(trace, stuck=stuck, answers=answers, **about)

    return observe
