"""A form: the process ends cleanly on Ctrl+C while a service of the node waits for a reply."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tutor.exercise.asking import Asking, open_desk, wait_for_both
from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program
from tutor.exercise.service_calls import ANSWER_S
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.ending import judge_ending, repeat_chance_failures
from tutor.judge.symptom import Symptom
from tutor.judge.tasks import Tasks
from tutor.judge.trace import Ending, Trace
from tutor.judge.verdict import Failure, Verdict, skipped

INTO_WAIT_S = 0.5
"""The node waits for the reply this long after its request has come."""


@dataclass(frozen=True)
class InterruptedAsking:
    """A run with Ctrl+C while the node waited for our reply. `asked`: whether it did."""

    trace: Trace
    asked: bool
    ending: Ending | None = None


@dataclass(frozen=True)
class InterruptWhileAsking:
    """Call the node, hold back our reply, and press Ctrl+C."""

    program: Program
    asking: Asking

    async def __call__(self, bench: Bench) -> InterruptedAsking:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> InterruptedAsking:
        asking, service, asked = self.asking, self.asking.service, False
        async with (
            bench.start(self.program.file, expected_s=2.0) as run,
            open_desk(run, asking) as desk,
            Tasks() as tasks,
        ):
            bench.report_progress(0.1, f"waiting for {service.name}")
            if await wait_for_both(run, self.program, asking):
                first = await desk.reach()
                before, desk.replies_at_once = len(desk.requests), False
                if first.answer.response is not None:
                    bench.report_progress(0.4, f"calling {service.name}, and holding back our reply")
                    request = asking.request(asking.requests[1])
                    tasks.start(run.call(service.name, service.type, request, limit_s=ANSWER_S))
                    asked = await run.until(lambda: len(desk.requests) > before, ANSWER_S)
                    into = run.now() + INTO_WAIT_S
                    await run.until(lambda: run.now() >= into, INTO_WAIT_S)
            trace = run.trace()
            bench.report_progress(0.7, "pressing Ctrl+C while it waits for our reply")
            return InterruptedAsking(trace, asked, await run.interrupt())


@dataclass(frozen=True)
class EndsWhileAsking(Form):
    """On Ctrl+C while the node waits for the reply of the service that it asks, the process ends as cleanly.

    See `EndsCleanly` for what that is. `shown_by`: the criterion that shows why the process had ended before Ctrl+C.
    """

    asking: Asking
    shown_by: Form

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, InterruptWhileAsking(exercise.program, self.asking))

    def judge(self, seen: InterruptedAsking) -> Verdict:
        """Judge the end."""
        if not seen.asked and seen.ending is not None:
            because = f"not judged, because {self.asking.asks.name} was not asked: `{self.shown_by.id}` shows why"
            return skipped(because)
        verdict = judge_ending(seen.trace, seen.ending, shown_by=self.shown_by.id)
        if isinstance(verdict, Failure) and verdict.seen is not None and verdict.seen.symptom is Symptom.DOES_NOT_END:
            says = f"the program still runs after Ctrl+C, which came while it waited for {self.asking.asks.name}"
            do = "Let no thread wait without a limit: Python ends only when all of its threads have ended."
            return replace(verdict, seen=replace(verdict.seen, says=says, do=do))
        return verdict
