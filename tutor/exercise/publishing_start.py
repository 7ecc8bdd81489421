"""A start without parameters: does the node publish, and go on publishing, and how does it end on Ctrl+C?"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

from tutor.exercise.nouns import Program, Topic
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.stuck_nodes import is_stuck_for_ever
from tutor.judge.trace import Echo, Ending, Sample, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import (
    IDLE_S,
    MESSAGE_GAP_S,
    RESENT_S,
    START_S,
    find_stuck_frames,
    too_few_by_cpu_wait,
    wait_for_message,
)
from tutor.ros_model import Graph, Parameter

MATCHED_S = 1.3
"""Messages sent within this time of the first sign of a publisher do not count: whether they reach us is a race.

Some nodes also pause for a second before a first message.
"""

GO_ON_S = 0.9
"""Messages go on arriving if those that count span this time."""

SLOW_S = 2.5
"""Messages that seem to come too slowly are watched until those that count span this time."""

SLOW_SHARE = 0.75
"""Messages come too slowly below this share of the rate asked for: in so short a time, a late one counts for much."""

ECHO_LIMIT_S = 14.0
"""Time limit of the echo: enough even for a topic with only an occasional message."""

SILENT_S = (1.5, 5.0)
"""A node that has sent nothing for this long may be stuck: we look twice."""

SPINNING_S = 1.0
"""Within this time, a node that spins answers a parameter request."""

ANSWER_S = 2.0
"""Time limit for an answer to a parameter request from a node that is up."""

NOT_STARTED = Trace("", graph=Graph(("/node",)))
"""The run of a scenario that did not start the program, since another one had shown enough: its node, for one."""


@dataclass(frozen=True)
class PublishingRun:
    """A start without parameters, interrupted with Ctrl+C at the end.

    `counted_from`: messages sent before this time do not count (see `MATCHED_S`), in seconds since the epoch.
    `parameters`: None if the node answered no parameter call, and, as nobody needs them then, if messages go on
    arriving. `echo`: None if they do not.
    `ending`: None if the process had already exited. `stuck`: the stack, innermost frame first, of a node that neither
    published nor answered. `stuck_for_ever`: by that stack, it will never publish. `cpu_wait_s`: how long the node
    waited for a CPU since its first message.
    """

    topic: str
    trace: Trace
    parameters: tuple[Parameter, ...] | None
    echo: Echo | None
    ending: Ending | None
    stuck: tuple[Frame, ...] = ()
    stuck_for_ever: bool = False
    counted_from: float = 0.0
    cpu_wait_s: float = 0.0

    @property
    def mean_hz(self) -> float:
        """The mean rate of the messages that count."""
        return mean_hz(self.trace.samples_on(self.topic), self.counted_from)

    def slowed_below(self, at_least_hz: float) -> bool:
        """Whether the machine may be to blame for messages that come too slowly."""
        sent = _counted(self.trace.samples_on(self.topic), self.counted_from)
        return too_few_by_cpu_wait(len(sent) - 1, at_least_hz, cpu_wait_s=self.cpu_wait_s, elapsed_s=_span_s(sent))

    @property
    def messages_go_on(self) -> bool:
        """Whether messages went on arriving, in whichever part of its start the node sent those that may be missing."""
        return go_on(self.trace.samples_on(self.topic), self.counted_from)


def go_on(samples: Sequence[Sample], counted_from: float) -> bool:
    """Whether the samples that were sent after this time span `GO_ON_S`."""
    return _span_s(_counted(samples, counted_from)) >= GO_ON_S


def mean_hz(samples: Sequence[Sample], counted_from: float) -> float:
    """The mean rate of the samples that were sent after this time; 0 if one alone was."""
    sent = _counted(samples, counted_from)
    return (len(sent) - 1) / _span_s(sent) if _span_s(sent) > 0 else 0.0


def _counted(samples: Sequence[Sample], counted_from: float) -> Sequence[Sample]:
    return [sample for sample in samples if sample.source_time >= counted_from]


def _span_s(samples: Sequence[Sample]) -> float:
    return samples[-1].source_time - samples[0].source_time if samples else 0.0


@dataclass(frozen=True)
class PublishingStart:
    """Start without parameters: do messages go on arriving, does echo show them, does Ctrl+C end it cleanly?

    `at_least_hz`: messages that come more slowly than this are watched for a while longer.
    """

    program: Program
    topic: Topic
    at_least_hz: float = 0.0

    async def __call__(self, bench: Bench) -> PublishingRun:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> PublishingRun:
        file, topic = self.program.file, self.topic
        tasks: list[asyncio.Future[Any]] = []
        stuck = _StuckNode(bench, file, topic)
        try:
            async with bench.start(file, watch=topic.watched, expected_s=7.0) as run:  # goes first: it decides a lot
                bench.report_progress(0.1, f"waiting for the first message on {topic.name}")
                began, looking = asyncio.ensure_future(self._first_sign_at(run)), asyncio.ensure_future(stuck.look(run))
                tasks += (began, looking)
                echo, declared, counted_from, waited_s = None, None, math.inf, 0.0
                if await wait_for_message(run, topic.name, topic.type, given_up=stuck.is_for_ever):
                    waited_s = run.node_cpu_wait_s()
                    bench.report_progress(0.5, "watching as `ros2 topic echo` does")
                    echoing = asyncio.ensure_future(run.echo(topic.name, samples=1, limit_s=ECHO_LIMIT_S))
                    asking = asyncio.ensure_future(run.parameters(ANSWER_S))
                    tasks += (echoing, asking)
                    counted_from = await self._wait_until_messages_go_on(run, await began, stuck)
                    if go_on(run.samples_on(topic.name), counted_from):
                        echo = await echoing
                    elif not stuck.is_for_ever():
                        declared = await asking
                elif not stuck.is_for_ever():
                    declared = await run.parameters(ANSWER_S)
                trace, waited_s = run.trace(), run.node_cpu_wait_s() - waited_s
                sent = tuple(
                    sample for sample in trace.samples_on(topic.name) if sample.source_time >= stuck.restarted_at
                )
                trace = replace(trace, samples={**trace.samples, topic.name: sent})
                bench.report_progress(0.8, "pressing Ctrl+C")
                ended = await run.interrupt()
            facts = PublishingRun(
                topic.name, trace, declared, echo, ended, (), stuck.is_for_ever(), counted_from, waited_s
            )
            if facts.messages_go_on or declared is not None or trace.exit is not None or not trace.graph.nodes:
                return facts
            return replace(facts, stuck=await looking or await find_stuck_frames(bench, file))
        finally:
            await cancel(tasks)

    async def _first_sign_at(self, run: Run) -> float:
        """Return when a publisher on the topic, or a message, is first seen."""
        await run.until(lambda: bool(run.samples_on(self.topic.name)) or self.topic.has_publisher(run), math.inf)
        return run.now()

    async def _wait_until_messages_go_on(self, run: Run, began: float, stuck: _StuckNode) -> float:
        """Wait until messages go on arriving, or no more come. Return from when on they count."""
        name = self.topic.name

        def counted_from() -> float:
            return max(began + MATCHED_S, stuck.restarted_at)

        def is_decided() -> bool:
            sent = _counted(run.samples_on(name), counted_from())
            slow = mean_hz(sent, 0.0) < SLOW_SHARE * self.at_least_hz
            return _span_s(sent) >= (SLOW_S if slow else GO_ON_S) or stuck.is_for_ever()

        received = -1
        while not is_decided() and len(run.samples_on(name)) != received:
            received = len(run.samples_on(name))
            await run.until(
                lambda received=received: is_decided() or len(run.samples_on(name)) != received,  # type: ignore[misc]
                MESSAGE_GAP_S,
                idle_s=IDLE_S,
            )
        return counted_from()


class _StuckNode:
    """A node that sends and answers nothing, and is perhaps stuck: the stack of another start shows it.

    `restarted_at`: when that start was made, in seconds since the epoch, or 0. A program that joins domains other than
    its own may send a message to its first run from there, so only later ones count.
    """

    def __init__(self, bench: Bench, file: str, topic: Topic) -> None:
        self._bench, self._file, self._topic = bench, file, topic
        self._for_ever = False
        self.restarted_at = 0.0

    def is_for_ever(self) -> bool:
        """Whether a stack has shown by now that no message can come."""
        return self._for_ever

    async def look(self, run: Run) -> tuple[Frame, ...]:
        """Once the node has sent nothing and answered nothing for a while, return the stack of another start; else ().

        Meanwhile, its next message may still come.
        """
        await run.until(lambda: bool(run.graph.nodes), START_S)
        up_at = run.now()

        def is_silent(for_s: float) -> bool:
            samples = run.samples_on(self._topic.name)
            return run.now() >= (samples[-1].received_at if samples else up_at) + for_s

        for silent_s in SILENT_S:
            await run.until(lambda for_s=silent_s: is_silent(for_s), math.inf)  # type: ignore[misc]
            if run.exit is None and await run.parameters(SPINNING_S) is None and is_silent(silent_s):
                self.restarted_at = run.now()
                frames = await find_stuck_frames(self._bench, self._file)
                self._for_ever = is_stuck_for_ever(run, frames)
                return frames
        return ()


@dataclass(frozen=True)
class AskForParameters:
    """Start without parameters, and ask which ones the node declares: None if it never answers."""

    program: Program
    topic: Topic

    async def __call__(self, bench: Bench) -> tuple[Parameter, ...] | None:
        topic = self.topic
        async with bench.start(self.program.file, watch=topic.watched, expected_s=5.0) as run:  # the probes wait for it
            bench.report_progress(0.1, "asking for its parameters")
            if not await run.until(lambda: bool(run.graph.nodes), START_S, idle_s=RESENT_S):
                return None
            # The services come with the node, unless it has been made without them.
            if not await run.until(lambda: bool(run.graph.parameter_nodes), RESENT_S, idle_s=RESENT_S):
                return None
            declared = await run.parameters(4.0)
            if declared is not None and not numeric(declared):
                await wait_for_message(run, topic.name, topic.type)  # the node may declare them late
                declared = await run.parameters(4.0)
            return declared


def numeric(declared: Sequence[Parameter]) -> list[Parameter]:
    """The learner's own numeric parameters, without the QoS overrides that rclpy declares."""
    return [p for p in declared if p.type in ("integer", "double") and not p.name.startswith("qos_overrides")]


async def cancel(tasks: Collection[asyncio.Future[Any]]) -> None:
    """Cancel tasks, and wait until they have ended."""
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
