"""A form: a bad value at start-up is reported by the name of its parameter."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass

from tutor.exercise.defaults import DeclaringRun, DeclaringStart
from tutor.exercise.form import Exercise, Form, parameter_node
from tutor.exercise.node_parameters import ParameterNode
from tutor.exercise.nouns import Parameter, Value
from tutor.exercise.set_at_start import SetAtStart, StartedWithParameters
from tutor.judge import tracebacks
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level, Trace
from tutor.judge.verdict import Verdict, failed, passed, skipped
from tutor.judge.waiting_for_nodes import IDLE_S, wait_until_seen
from tutor.judge.wording import output_tail, shape


@dataclass(frozen=True)
class StartWithBadValues:
    """Start with each of the bad values: does the node report which parameter is wrong?"""

    node: ParameterNode
    parameter: Parameter
    bad: tuple[Value, ...]

    async def __call__(self, bench: Bench) -> tuple[Trace, ...]:
        return tuple(await asyncio.gather(*(self._start(bench, value) for value in self.bad)))

    async def _start(self, bench: Bench, value: Value) -> Trace:
        node, name = self.node, self.parameter.name
        async with bench.start(
            node.program.file, parameters={name: value}, watch=node.topic.watched, expected_s=0.5
        ) as run:
            bench.report_progress(0.3, f"starting with {name}:={value}")
            if await wait_until_seen(
                run, lambda: run.exit is not None or bool(messages_naming(name, run.trace())), idle_s=IDLE_S
            ):
                await run.until(lambda: run.exit is not None, 1.0)  # the report may come in more than one message
            return run.trace()


def messages_naming(name: str, trace: Trace) -> list[str]:
    """The lines, logged or printed, that name a parameter; source lines in a traceback do not count.

    Nor does rclpy's complaint that a parameter is already declared, which has nothing to do with its value.
    """
    lines = [*(log.text for log in trace.logs), *tracebacks.lines_without_tracebacks(trace.output)]
    return [line for line in lines if name in line and "ParameterAlreadyDeclaredException" not in line]


@dataclass(frozen=True)
class NamesBadValue(Form):
    """A start with a bad value gives a message that names the parameter, not just a traceback.

    Judged only where a good value is taken at start-up, if a SetAtStart of the exercise sets it.
    """

    parameter: Parameter
    bad: tuple[Value, ...]

    def criterion(self, exercise: Exercise) -> Criterion:
        node = parameter_node(exercise)
        starts = exercise.first(SetAtStart, lambda form: any(self.parameter in given for given in form.starts))

        def judge(plain: DeclaringRun, seen: Sequence[Trace], good: StartedWithParameters | None) -> Verdict:
            if starts is not None and good is not None and not good.took_rate:
                because = f"the node does not take a good {self.parameter.name} at start-up either: see `{starts.id}`"
                return skipped(f"not judged, because {because}")
            return self.judge(plain, seen)

        bad = StartWithBadValues(node, self.parameter, self.bad)
        return self.judged(judge, DeclaringStart(node), bad, exercise.scenario_of(starts))

    def judge(self, plain: DeclaringRun, seen: Sequence[Trace]) -> Verdict:
        """Judge the starts with bad values beside one without parameters."""
        name = self.parameter.name
        starts = " or ".join(f"{name}:={value}" for value in self.bad)
        expected = f"a start with {starts} gives a message that names {name}"
        ordinary = {_wording(line) for line in messages_naming(name, plain.trace)}
        for trace in seen:
            if not any(_wording(line) not in ordinary for line in messages_naming(name, trace)):
                given = f"{name}:={trace.parameters[name]}"
                found = tracebacks.last_traceback(trace)
                warning = next((str(log) for log in reversed(trace.logs) if log.level >= Level.WARN), "")
                why = Symptom.BAD_VALUE_ACCEPTED.seen(
                    trace, parameter=name, value=trace.parameters[name], at_start=True, warning=warning
                )
                observed = f"with {given}: {found.plain if found else warning or 'no message about it'}"
                return failed(expected, observed, why, output_tail(trace))
        return passed(expected, "it does", [messages_naming(name, trace)[-1] for trace in seen])


def _wording(line: str) -> str:
    """Strip a line of numbers and its log prefix, so that it can be compared with those of an ordinary start."""
    return shape(line.rsplit("]: ", 1)[-1])
