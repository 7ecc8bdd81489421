"""How scenarios find the node with the parameters, wait for it, and read them; and failures that they share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tutor.exercise.nouns import Parameter, Program, SetsRate, Topic, show
from tutor.judge.bench import Bench, Run
from tutor.judge.rates import Rate, measure
from tutor.judge.stuck_nodes import ask_unless_stuck
from tutor.judge.symptom import Symptom
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Verdict, failed
from tutor.judge.waiting_for_nodes import RESENT_S, START_S, find_stuck_frames, wait_for_message, wait_for_publisher
from tutor.judge.wording import describe_no_answer, output_tail
from tutor.ros_model import Parameter as Reported

ANSWER_S = 5.0
"""Timeout of a parameter call."""

MESSAGE_GAP_S = 3.0
"""Time within which an existing publisher of at least 1 Hz sends something, even on a slow machine."""


@dataclass(frozen=True)
class DumpSilentNode:
    """Start without parameters and return the node's stack while it answers nothing."""

    program: Program

    async def __call__(self, bench: Bench) -> tuple[Frame, ...]:
        return await find_stuck_frames(bench, self.program.file)


@dataclass(frozen=True)
class ParameterNode:
    """A node with parameters that do something to what it publishes on a topic."""

    program: Program
    topic: Topic
    parameters: tuple[Parameter, ...]

    @property
    def rate(self) -> Parameter | None:
        """The parameter that sets the rate, if there is one."""
        return next((parameter for parameter in self.parameters if isinstance(parameter.effect, SetsRate)), None)

    @property
    def default_hz(self) -> float:
        """The rate by default."""
        return float(self.rate.default) if self.rate is not None else 1.0

    async def dump_if_stuck(self, bench: Bench, trace: Trace, answering: bool = False) -> tuple[Frame, ...]:
        """Return the stack of a node that, by this trace, is up but does nothing and answers nothing; else ()."""
        is_silent = bool(trace.graph.nodes) and trace.exit is None and not answering
        return await bench.facts(DumpSilentNode(self.program)) if is_silent else ()

    async def find(self, bench: Bench, run: Run) -> str | None:
        """Find the node to talk to: the one with most of the required parameters. None if no node answers."""
        if not await run.until(lambda: bool(run.graph.parameter_nodes), START_S, idle_s=RESENT_S):
            return None
        declared, _ = await ask_unless_stuck(run, ANSWER_S, lambda: bench.facts(DumpSilentNode(self.program)))
        if declared is None:
            return None
        names = {parameter.name for parameter in self.parameters}
        holders = [reported.node for reported in declared if reported.name in names]
        return max(holders or run.graph.parameter_nodes, key=holders.count, default=None)

    async def wait_for_message(self, run: Run) -> bool:
        """Wait for a message, and return whether there is one."""
        return await wait_for_message(run, self.topic.name, self.topic.type, message_gap_s=MESSAGE_GAP_S)

    async def wait_until_publishing(self, bench: Bench, run: Run) -> tuple[str | None, bool]:
        """Return the node to talk to once it publishes (None if it does not), and whether it answers."""
        bench.report_progress(0.05, "waiting for it to publish")
        node = await self.find(bench, run)
        publishes = node is not None and await self.wait_for_message(run)
        return (node if publishes else None), node is not None

    async def wait_until_ready(self, bench: Bench, run: Run, *, at_once: bool) -> str | None:
        """Return the node to talk to once it publishes, or with `at_once`, as soon as it has its publisher.

        None if no node answers.
        """
        node = await self.find(bench, run)
        if node is not None and not at_once:
            await self.wait_for_message(run)
        elif node is not None:
            await wait_for_publisher(run, self.topic.name, self.topic.type)
        return node

    async def read_base_hz(self, run: Run) -> float:
        """Read the rate that the node starts at: the default, or a wrong default from 0.5 to 10 Hz.

        Where no parameter sets the rate, it is measured.
        """
        if self.rate is None:
            await run.until(lambda: len(run.samples_on(self.topic.name)) > 1, MESSAGE_GAP_S)
            measured = measure(run.samples_on(self.topic.name))
            return min(10.0, measured.hz) if measured is not None else self.default_hz
        value = (await read(run, self.rate))[0]
        return float(value) if isinstance(value, (int, float)) and 0.5 <= value <= 10 else self.default_hz


async def read(run: Run, *parameters: Parameter) -> tuple[Any, ...]:
    """Read these parameters; None for each that the node does not have."""
    declared = await run.parameters(ANSWER_S) or ()
    found = [find_parameter(declared, parameter) for parameter in parameters]
    return tuple(reported.value if reported else None for reported in found)


async def set_values(run: Run, node: str, *given: tuple[Parameter, Any], atomic: bool = False) -> SetAnswer:
    """Set parameters as `ros2 param set` does, or all in one atomic request."""
    values = {parameter.name: value for parameter, value in given}
    return await run.set_parameters(node, values, atomic=atomic, limit_s=ANSWER_S)


def find_parameter(declared: Sequence[Reported], wanted: Parameter) -> Reported | None:
    """What the node reports of this parameter, or None."""
    return next((reported for reported in declared if reported.name == wanted.name), None)


def fail_not_running(
    node: ParameterNode, expected: str, trace: Trace, stuck: tuple[Frame, ...], answering: bool
) -> Verdict:
    """Fail a node that nothing can be asked of: it publishes nothing, or answers nothing."""
    topic = node.topic
    if trace.samples_on(topic.name):
        silent = Symptom.NO_ANSWER.seen(trace, stuck=stuck, answers=False)
        return failed(expected, "the node answers no parameter call", silent, output_tail(trace))
    missing = Symptom.NO_MESSAGES.seen(trace, stuck=stuck, answers=answering, topic=topic.name, type=topic.type)
    return failed(expected, f"no message on {topic.name} to start with", missing, output_tail(trace))


def fail_not_set(expected: str, answer: SetAnswer, trace: Trace, stuck: Sequence[Frame]) -> Verdict:
    """Fail a node that does not answer a parameter request, or rejects one that it should accept."""
    what, name = _describe_values(answer), next(iter(answer.values))
    if not answer.answered:
        silent = Symptom.NO_ANSWER.seen(trace, stuck=tuple(stuck), parameter=name)
        observed = f"setting {what}: {describe_no_answer(trace, answer.took_s, ANSWER_S)}"
        return failed(expected, observed, silent, output_tail(trace))
    refused = Symptom.REFUSED.seen(trace, parameter=name, value=answer.values[name], answer=answer)
    return failed(expected, f'setting {what}: rejected, "{answer.reason}"', refused)


def describe_refusal(answer: SetAnswer) -> str:
    """Say that good values were rejected, so that the rejection of bad ones shows nothing."""
    return f'the node rejects good values, too (setting {_describe_values(answer)}: "{answer.reason}")'


def _describe_values(answer: SetAnswer) -> str:
    return ", ".join(f"{name} to {show(value)}" for name, value in answer.values.items())


def are_alike(rate: Rate, other: Rate | None) -> bool:
    """Whether two rates are about the same, although different ones were requested."""
    return other is not None and max(rate.hz, other.hz) < 1.1 * min(rate.hz, other.hz)


def is_unchanged(rate: Rate | None, hz: float, *, at_start: Rate | None, before: Rate | None = None) -> bool:
    """Whether the rate is still `hz`, or `before`, if it was measured after `hz` was set, or else `at_start`.

    `at_start`: what another start without parameters has actually published at.
    """
    if rate is None or rate.agrees_with(hz):
        return rate is not None
    if before is not None:
        return rate.agrees_with(before.hz)  # the difference from `hz`, as by a timer left running, was there already
    return at_start is not None and at_start.agrees_with(rate.hz)
