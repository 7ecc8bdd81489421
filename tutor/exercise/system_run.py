"""Forms about a system of several nodes: the one launch that they share, and how each of them looks at it.

Each is judged on what was seen of the whole launch. What is not seen is said as it looks from outside, and never why:
to find that out may be the exercise.
"""

from __future__ import annotations

import asyncio
from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.launch_run import LaunchRun
from tutor.exercise.launch_symptoms import seen_in_launch
from tutor.exercise.nouns import LaunchFile, Topic
from tutor.exercise.publishing_start import cancel
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.launch_output import ended_processes
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Verdict
from tutor.judge.waiting_for_nodes import CPU_WAIT_SHARE, HARDLY_WAITED_SHARE, IN_FLIGHT_S, START_S

COMPARE = "Follow it from node to node, and compare what `ros2` shows with what was handed over."
"""The next step where a system does not do what it should."""


@dataclass(frozen=True)
class Sent:
    """A value that we have published. `at`: in seconds since the epoch."""

    topic: str
    value: Any
    at: float


@dataclass(frozen=True)
class SystemRun(LaunchRun):
    """One launch of a system. `sent`: what we have published.

    `seen_from`, `seen_until`: from when all its nodes were up, until we stopped looking, in seconds since the epoch.
    `cpu_wait_s`: how long its processes waited for a CPU in that time, all together.
    """

    sent: tuple[Sent, ...] = ()
    seen_from: float = 0.0
    seen_until: float = 0.0
    cpu_wait_s: float = 0.0

    @property
    def slowed(self) -> bool:
        """Whether the machine may be to blame for what was seen (see `tutor.judge.bench.was_slowed`)."""
        return self.cpu_wait_s >= HARDLY_WAITED_SHARE * (self.seen_until - self.seen_from)

    @property
    def starved(self) -> bool:
        """Whether its processes had to wait so much that nothing can be said of their timing."""
        return self.cpu_wait_s >= CPU_WAIT_SHARE * (self.seen_until - self.seen_from)

    @property
    def broken(self) -> bool:
        """Whether the launch has ended, has lost a process, or has made no node."""
        trace = self.trace
        return trace.exit is not None or bool(ended_processes(trace.output)) or not trace.graph.nodes

    def not_as_it_should(self, says: str, do: str = COMPARE) -> Observation:
        """The symptom of a system that does not do something; of a broken launch, that it does not start."""
        if self.broken:
            return seen_in_launch(Symptom.NOT_LAUNCHED, self)
        return Symptom.SYSTEM_FAULT.seen(self.trace, says=says, do=do)


@dataclass(frozen=True)
class RunSystem:
    """Launch without arguments, let each form look, all at once, and press Ctrl+C."""

    launch_file: LaunchFile
    forms: tuple[SystemForm, ...]

    async def __call__(self, bench: Bench) -> SystemRun:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> SystemRun:
        sent: list[Sent] = []
        nodes = max((form.nodes for form in self.forms), default=1)
        async with bench.launch(self.launch_file.file) as run:
            bench.report_progress(0.1, "launching the system")
            for topic in dict.fromkeys(topic for form in self.forms for topic in form.watched):
                run.watch(topic.name, topic.type)
            await run.until(lambda: len(run.graph.nodes) >= nodes or bool(ended_processes(run.output)), START_S)
            bench.report_progress(0.3, "watching what it does")
            seen_from, waited_s = run.now(), run.node_cpu_wait_s()
            tasks = [asyncio.ensure_future(form.look(run, sent)) for form in self.forms]
            try:
                await asyncio.gather(*tasks)
            finally:
                await cancel(tasks)
            trace, seen_until, cpu_wait_s = run.trace(), run.now(), run.node_cpu_wait_s() - waited_s
            command_lines = run.command_lines()
            bench.report_progress(0.8, "pressing Ctrl+C")
            return SystemRun(
                trace,
                command_lines=command_lines,
                ending=await run.interrupt(),
                sent=tuple(sent),
                seen_from=seen_from,
                seen_until=seen_until - IN_FLIGHT_S,
                cpu_wait_s=cpu_wait_s,
            )


@dataclass(frozen=True)
class SystemForm(Form):
    """A criterion that is judged on the launch that all forms of this kind look at."""

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> RunSystem:
        forms = tuple(form._alone for form in exercise.forms if isinstance(form, SystemForm))
        return RunSystem(exercise.launch_file, forms)

    @property
    def _alone(self) -> SystemForm:
        """The form as a value of its own, whatever it is `after`."""
        return replace(self, after=(), bonus=False)

    @property
    def watched(self) -> tuple[Topic, ...]:
        """The topics whose messages it looks at."""
        return ()

    @property
    def nodes(self) -> int:
        """How many nodes must be up before anything can be expected."""
        return 1

    async def look(self, run: Run, sent: list[Sent]) -> None:
        """Wait until it can be judged; what it publishes is added to `sent`."""

    @abstractmethod
    def judge(self, seen: SystemRun) -> Verdict:
        """Judge the launch."""
