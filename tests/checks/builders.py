"""Builders for the facts that a check could have observed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tutor.judge.check import Check, EarlyJudge, Judge
from tutor.judge.rates import Rate
from tutor.judge.trace import CallAnswer, Ending, Exit, LogRecord, OutputLine, Sample, SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Failure, Status, Undecided, Verdict
from tutor.mistakes.diagnosis import explain
from tutor.ros_model import Graph, Parameter, ServiceEndpoint, TopicEndpoint

FOLDER = "/home/me/ws"
START = 1000.0

CRASH = f"""\
Traceback (most recent call last):
  File "{FOLDER}/node.py", line 30, in <module>
    main()
  File "{FOLDER}/node.py", line 12, in tick
    self.nothing()
    ^^^^^^^^^^^^
AttributeError: 'Sensor' object has no attribute 'nothing'"""

KEYBOARD_INTERRUPT = f"""\
Traceback (most recent call last):
  File "{FOLDER}/node.py", line 30, in <module>
    main()
  File "/venv/lib/python3.12/site-packages/rclpy/executors.py", line 296, in spin
    self.spin_once()
KeyboardInterrupt"""


def lines(text: str, stream: str = "stderr", at: float = START) -> tuple[OutputLine, ...]:
    """The lines of `text` as output, all written at time `at`."""
    return tuple(OutputLine(stream, line, at) for line in text.splitlines())


def sample(topic: str, data: Any, at: float) -> Sample:
    return Sample(topic, {"data": data}, at, at + 0.001)


def samples(topic: str, hz: float, *, count: int = 10, data: Any = "Hello") -> tuple[Sample, ...]:
    """`count` messages at a steady rate."""
    return tuple(sample(topic, data, START + 1 + i / hz) for i in range(count))


def rate(hz: float) -> Rate:
    """A steady rate, measured over ten messages."""
    return Rate(hz, 10, 9 / hz)


def log(text: str, level: int = 20) -> LogRecord:
    return LogRecord(level, "node", text, START, START)


def publisher(topic: str, type_name: str) -> TopicEndpoint:
    return TopicEndpoint(topic, type_name, "/node")


def graph(
    nodes: Sequence[str] = ("/node",),
    publishers: Mapping[str, str] | None = None,
    services: Mapping[str, str] | None = None,
) -> Graph:
    """A graph in which `publishers` and `services` map names to types."""
    return Graph(
        nodes=tuple(nodes),
        publishers=tuple(publisher(topic, type_name) for topic, type_name in (publishers or {}).items()),
        servers=tuple(ServiceEndpoint(name, type_name, "/node") for name, type_name in (services or {}).items()),
    )


NODE_UP = graph()
"""A node is up and offers nothing."""


def exited(code: int | None = 0, *, signal: int | None = None, after_s: float = 1.0) -> Exit:
    return Exit(code if signal is None else None, signal, after_s)


def trace(
    *messages: Sample,
    graph: Graph = NODE_UP,
    err: str = "",
    out: str = "",
    logs: Iterable[LogRecord] = (),
    exit: Exit | None = None,
    **more: Any,
) -> Trace:
    """A run of node.py and what was observed of it; without arguments, a node that runs and writes nothing."""
    by_topic: dict[str, tuple[Sample, ...]] = {}
    for message in messages:
        by_topic[message.topic] = (*by_topic.get(message.topic, ()), message)
    return Trace(
        file="node.py",
        folder=FOLDER,
        started_at=START,
        samples=by_topic,
        logs=tuple(logs),
        graph=graph,
        output=(*lines(out, "stdout"), *lines(err)),
        exit=exit,
        **more,
    )


NO_NODE = trace(graph=Graph())
CRASHED = trace(graph=Graph(), err=CRASH, exit=exited(1))


def ending(code: int | None = 0, *, signal: int | None = None, err: str = "", still_running: bool = False) -> Ending:
    """How the process ended after Ctrl+C."""
    return Ending(None if still_running else exited(code, signal=signal, after_s=3.0), 0.14, 5.0, lines(err))


def parameter(name: str, type_name: str, value: Any, **more: Any) -> Parameter:
    return Parameter("/node", name, type_name, value, **more)


def answer(values: Mapping[str, Any], reason: str = "", *, successful: bool = True, answered: bool = True) -> SetAnswer:
    """The answer to setting parameters."""
    took_s = 0.01 if answered else 5.0
    return SetAnswer(values, answered, answered and successful, reason, START + 1, START + 1 + took_s)


def refused(values: Mapping[str, Any], reason: str = "the rate must be > 0") -> SetAnswer:
    return answer(values, reason, successful=False)


def called(service: str, a: int, b: int, result: int | None) -> CallAnswer:
    """A service call; a `result` of None means that it was not answered."""
    response = None if result is None else {"sum": result}
    took_s = 5.0 if result is None else 0.01
    return CallAnswer(service, {"a": a, "b": b}, response, START, START + took_s)


def frame(function: str, path: str = f"{FOLDER}/node.py", line: int = 12, code: str = "pass") -> Frame:
    return Frame(path, line, function, code)


EXECUTING = frame("await_or_execute", "/venv/rclpy/executors.py")
"""The executor's frame below that of a callback."""


def assert_passed(verdict: Verdict | None) -> None:
    assert verdict is not None
    assert verdict.status is Status.PASSED, verdict
    assert verdict.expected
    assert verdict.observed
    assert verdict.cause == ""


def assert_undecided(verdict: Verdict) -> None:
    assert isinstance(verdict, Undecided), verdict


def judge_of(check: Check, criterion: str) -> Judge:
    """The judge of a criterion."""
    return next(one.judge for one in check.criteria if one.id == criterion)


def early_judge_of(check: Check, criterion: str) -> EarlyJudge:
    """The early judge of a criterion that has one."""
    ((_, judge),) = next(one.early for one in check.criteria if one.id == criterion)
    return judge


def explained(verdict: Verdict, check: Check) -> Verdict:
    """The verdict with its cause and next step, if it is a failure whose reason is still to be found."""
    return explain(verdict, check) if isinstance(verdict, Failure) else verdict


def assert_skipped(verdict: Verdict, words: str) -> None:
    """Fail unless the verdict is "skipped", for a reason that contains these words."""
    assert verdict.status is Status.SKIPPED, verdict
    assert words in verdict.cause, verdict


def assert_failed(verdict: Verdict | None, cause: str, *words: str, check: Check | None = None) -> None:
    """Fail unless the verdict failed with the cause of this name, is complete, and contains these words.

    `check`: whose catalogue says why.
    """
    assert verdict is not None
    assert verdict.status is Status.FAILED, verdict
    verdict = explained(verdict, check) if check is not None else verdict
    assert verdict.cause.partition(":")[0] == cause, verdict
    assert verdict.expected
    assert verdict.observed
    assert verdict.step
    for word in words:
        assert word in f"{verdict.observed} | {verdict.cause} | {verdict.step} | {verdict.evidence}", verdict
