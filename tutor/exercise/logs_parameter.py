"""A form: the value of some text parameter, set at start-up, appears in the node's log."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program, Topic
from tutor.exercise.publishing_start import ANSWER_S, AskForParameters, PublishingStart, cancel
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import OutputLine, Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.waiting_for_nodes import IDLE_S, MESSAGE_GAP_S, RESENT_S, wait_until_seen
from tutor.ros_model import Parameter
from tutor.source.log_calls import logs_the_same_on_each_message

USUALLY_LOGGED_S = 3.0
"""Most nodes have logged their name within this time."""

LOG_DELAY_S = 0.5
"""Upper bound on the latency of a log message, apart from our own wait for a CPU."""


@dataclass(frozen=True)
class NameProbe:
    """A start with the string parameter `name` set to `value`.

    `found`: the log message that contains the value, or "". `at_end`: if none does, the output during shutdown.
    """

    name: str
    value: str
    found: str
    trace: Trace
    at_end: tuple[OutputLine, ...] = ()

    @property
    def is_printed(self) -> bool:
        return any(self.value in line.text for line in (*self.trace.output, *self.at_end))


@dataclass(frozen=True)
class NameProbes:
    """All starts that probed a name. `declared`: None if the node answered no parameter call."""

    declared: tuple[Parameter, ...] | None
    probes: tuple[NameProbe, ...]


@dataclass(frozen=True)
class ProbeNames:
    """Start once for each string parameter, set to a value that nothing else would log, until one is logged.

    `suggested`, the skeleton's parameter name, is probed while the node is still asked for its parameters: it is probed
    in any case, since the node may answer no call, or accept parameters that it does not declare.
    """

    program: Program
    topic: Topic
    suggested: str

    async def __call__(self, bench: Bench) -> NameProbes:
        known: set[str] = set()
        probes: list[NameProbe] = []
        pending = {asyncio.ensure_future(self._probe(bench, known, 0, self.suggested))}
        try:
            declared = await bench.facts(AskForParameters(self.program, self.topic))
            known.update(p.name for p in declared or ())
            others = [p.name for p in declared or () if p.type == "string" and p.name != self.suggested]
            pending.update(
                asyncio.ensure_future(self._probe(bench, known, number, name))
                for number, name in enumerate(others, start=1)
            )
            while pending and not any(probe.found for probe in probes):  # one that is logged is enough
                done, pending = await asyncio.wait(pending, return_when=asyncio.FIRST_COMPLETED)
                probes.extend(task.result() for task in done)
        finally:
            await cancel(pending)
        return NameProbes(declared, tuple(sorted(probes, key=lambda probe: probe.name not in known)))  # declared first

    async def _probe(self, bench: Bench, known: set[str], number: int, name: str) -> NameProbe:
        """Start with one parameter set. `known`: the declared ones, filled once the node has answered."""
        topic = self.topic
        value = f"probe_{number}_kx7"
        async with bench.start(self.program.file, parameters={name: value}, watch=topic.watched, expected_s=0.5) as run:
            bench.report_progress(0.3, f"{name}:={value}, reading its log")

            def contains_value(text: str) -> bool:
                # `name:=value` counts only for a declared parameter: otherwise it may be the logged command line.
                return value in (text if name in known else text.replace(f":={value}", ""))

            def logged() -> str:
                return next((str(log) for log in run.logs if contains_value(str(log).casefold())), "")

            repeats = logs_the_same_on_each_message(run.trace().sources)
            since, waited_s = run.now(), run.our_cpu_wait_s()

            def has_published(messages: int, *, for_s: float = LOG_DELAY_S) -> bool:
                """Whether it has published this many messages, and the log of the last one must have arrived."""
                samples, delay_s = run.samples_on(topic.name), for_s + run.our_cpu_wait_s() - waited_s
                return len(samples) >= messages and run.now() >= samples[messages - 1].received_at + delay_s

            def is_decided() -> bool:
                """Whether the name is logged, or never will be."""
                if logged():
                    return True
                # Without any log message, it may be that the first ones were lost, and are resent later.
                return repeats and (has_published(2) if run.logs else has_published(2, for_s=RESENT_S))

            async def wait(seen: Callable[[], bool], limit_s: float) -> None:
                await wait_until_seen(run, seen, promised=lambda: True, message_gap_s=limit_s, idle_s=IDLE_S)

            await wait(lambda: is_decided() or has_published(3), USUALLY_LOGGED_S)
            declared = await bench.facts(AskForParameters(self.program, topic))
            if not is_decided():
                plain = asyncio.ensure_future(bench.facts(PublishingStart(self.program, topic)))

                def is_over() -> bool:
                    stuck = plain.done() and plain.exception() is None and plain.result().stuck_for_ever
                    return stuck or is_decided()

                try:
                    await wait(lambda: is_over() or has_published(3), MESSAGE_GAP_S - (run.now() - since))
                    if not is_over() and not await _ignores(run, name, declared):
                        # Many nodes log every tenth message, which takes 10 s at 1 Hz, from the first one on.
                        samples = run.samples_on(topic.name)
                        began = samples[0].received_at if samples else since
                        await wait(is_over, MESSAGE_GAP_S - (run.now() - began))
                finally:
                    await cancel([plain])
            found, trace = logged(), run.trace()
            ended = await run.interrupt() if not found else None
            return NameProbe(name, value, found, trace, ended.output if ended else ())


async def _ignores(run: Run, name: str, declared: tuple[Parameter, ...] | None) -> bool:
    """Whether the node has not declared this parameter, neither by itself nor because it was given at start-up."""
    if declared is None or any(parameter.name == name for parameter in declared):
        return False
    given = await run.parameters(ANSWER_S)
    return given is not None and all(parameter.name != name for parameter in given)


@dataclass(frozen=True)
class LogsParameter(Form):
    """Some text parameter, set at start-up, appears in the node's log (logged, not printed; once is enough).

    Its name is the learner's choice. `topic`: what the node publishes meanwhile, from which we know how far it is.
    `suggested`: the skeleton's name. `what`: what the parameter is, in words.
    """

    topic: Topic
    suggested: str
    what: str

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, ProbeNames(exercise.program, self.topic, self.suggested))

    def judge(self, found: NameProbes) -> Verdict:
        """Judge all starts that probed a name."""
        expected = "some string parameter, set at start-up, appears in the node's log messages"
        for probe in found.probes:
            if probe.found:
                return passed(expected, f"{probe.name}:={probe.value} is logged", [probe.found])
        probe = found.probes[0]
        if found.declared is not None and probe.name not in {parameter.name for parameter in found.declared}:
            return failed(expected, "no string parameter is declared", self._not_declared(probe.trace))
        evidence = [str(log) for log in probe.trace.logs[-5:]]
        observed = f"{probe.name}:={probe.value} is in none of {len(probe.trace.logs)} log messages"
        return failed(expected, observed, self._not_logged(found), evidence)

    def _not_declared(self, trace: Trace) -> Observation:
        return Symptom.NOT_DECLARED.seen(trace, parameter=self.suggested, what=self.what, type="string")

    def _not_logged(self, found: NameProbes) -> Observation:
        name, type_name = self.topic.name, self.topic.type
        traces = [probe.trace for probe in found.probes]
        silent = next((trace for trace in traces if not trace.logs and not trace.samples_on(name)), None)
        if silent is not None and any(publisher.topic == name for publisher in silent.graph.publishers):
            return Symptom.NO_MESSAGES.seen(silent, answers=found.declared is not None, topic=name, type=type_name)
        if found.declared is None and not any(probe.is_printed for probe in found.probes):
            return self._not_declared(traces[0])
        names = {parameter.name for parameter in found.declared or ()}
        declared = [probe for probe in found.probes if probe.name in names]
        probe = next((probe for probe in found.probes if probe.is_printed), (declared or found.probes)[0])
        return Symptom.NOT_LOGGED.seen(
            probe.trace,
            parameter=probe.name,
            what=self.what,
            value=probe.value,
            at_end=probe.at_end,
            says=f"{probe.name} is declared, but its value is in no log message",
            do="Put the parameter's value into a message that the node logs.",
        )
