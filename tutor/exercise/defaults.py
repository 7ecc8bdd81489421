"""A form: the parameters that the node declares, with their types and defaults."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form, parameter_node
from tutor.exercise.node_parameters import ANSWER_S, ParameterNode, find_parameter
from tutor.exercise.nouns import Parameter, show
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import output_tail
from tutor.ros_model import Parameter as Reported


@dataclass(frozen=True)
class DeclaringRun:
    """A start without parameters, interrupted with Ctrl+C at the end.

    `parameters`: None if no node answered. `ending`: None if the process had already exited. `stuck`: the stack,
    innermost frame first, of a node that answered nothing.
    """

    trace: Trace
    parameters: tuple[Reported, ...] | None
    ending: Ending | None
    stuck: tuple[Frame, ...] = ()


@dataclass(frozen=True)
class DeclaringStart:
    """Start without parameters: which ones does it declare, and does Ctrl+C end it cleanly?"""

    node: ParameterNode

    async def __call__(self, bench: Bench) -> DeclaringRun:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> DeclaringRun:
        node = self.node
        # It goes first: it decides a lot on its own.
        async with bench.start(node.program.file, watch=node.topic.watched, expected_s=7.0) as run:
            bench.report_progress(0.2, "asking for its parameters")
            name = await node.find(bench, run)
            declared = await run.parameters(ANSWER_S) if name else None
            bench.report_facts(DeclaringRun(run.trace(), declared, None))
            bench.report_progress(0.5, "waiting for a message, then pressing Ctrl+C")
            if name:
                await node.wait_for_message(run)
            trace = run.trace()
            ended = await run.interrupt()
        return DeclaringRun(
            trace, declared, ended, () if declared is not None else await node.dump_if_stuck(bench, trace)
        )


@dataclass(frozen=True)
class Defaults(Form):
    """The node declares these parameters, with these types and defaults."""

    parameters: tuple[Parameter, ...]

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise), early=self.judge_so_far)

    def ended_start(self, exercise: Exercise) -> DeclaringStart:
        return DeclaringStart(parameter_node(exercise))

    def judge(self, seen: DeclaringRun) -> Verdict:
        """Judge a start without parameters."""
        expected = ", ".join(f"{p.name} = {show(p.default)} ({p.type})" for p in self.parameters)
        if seen.parameters is None:
            silent = Symptom.NO_ANSWER.seen(seen.trace, stuck=seen.stuck, answers=False)
            return failed(expected, "the node answers no parameter call", silent, output_tail(seen.trace))
        found = {wanted: find_parameter(seen.parameters, wanted) for wanted in self.parameters}
        observed = ", ".join(
            f"{wanted.name} = {show(p.value)} ({p.type})" if p else f"no {wanted.name}" for wanted, p in found.items()
        )
        for wanted, reported in found.items():
            if reported is None or (reported.type, reported.value) != (wanted.type, wanted.default):
                why = Symptom.NOT_DECLARED.seen(
                    seen.trace, parameter=wanted.name, type=wanted.type, default=wanted.default, found=reported
                )
                return failed(expected, observed, why)
        return passed(expected, observed)

    def judge_so_far(self, seen: DeclaringRun) -> Verdict | None:
        """Judge as soon as the node has reported its parameters."""
        return self.judge(seen) if seen.parameters is not None else None
