"""A form: the process ends cleanly on Ctrl+C."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program
from tutor.judge.bench import Bench, Scenario
from tutor.judge.check import Criterion
from tutor.judge.ending import judge_ending, repeat_if_doubtful
from tutor.judge.trace import Ending, Trace
from tutor.judge.verdict import Status, Verdict
from tutor.judge.waiting import NO_NODE_S, START_S

ANSWER_S = 2.0
"""Time limit for the answer to a parameter request, by which a node shows that it spins."""


@dataclass(frozen=True)
class EndedRun:
    """A start without parameters, ended with Ctrl+C. `ending`: None if the process had ended before."""

    trace: Trace
    ending: Ending | None


@dataclass(frozen=True)
class StartAndEnd:
    """Start without parameters, and press Ctrl+C once the node spins."""

    program: Program

    async def __call__(self, bench: Bench) -> EndedRun:
        return await repeat_if_doubtful(self._run)(bench)

    async def _run(self, bench: Bench) -> EndedRun:
        async with bench.start(self.program.file) as run:
            if await run.until(lambda: bool(run.graph.nodes), START_S, idle_s=NO_NODE_S):
                await run.parameters(ANSWER_S)
            trace = run.trace()
            bench.report_progress(0.8, "pressing Ctrl+C")
            return EndedRun(trace, await run.interrupt())


@dataclass(frozen=True)
class EndsCleanly(Form):
    """On Ctrl+C (SIGINT) the process ends within 5 s, without a traceback, with exit code 0 or 130.

    Judged on the start without parameters of the first criterion that makes one, or else on a start of its own. It is
    skipped where the process had ended before Ctrl+C, with the criterion that shows why. `start`: another scenario to
    judge it on, whose facts have `trace` and `ending`.
    """

    start: Scenario[Any] | None = None

    def criterion(self, exercise: Exercise) -> Criterion:
        others = [form for form in exercise.forms if form is not self and not form.bonus]
        started = [(form, start) for form in others if (start := form.ended_start(exercise)) is not None]
        if not started or self.start is not None:
            shown_by, start = others[0].id if others else self.id, self.start or StartAndEnd(exercise.program)
            return self.judged(lambda seen: judge_ending(seen.trace, seen.ending, shown_by=shown_by), start)
        form, start = started[0]
        following = [*others[others.index(form) + 1 :], form][0]
        judge_start = form.criterion(exercise).judge

        def judge(seen: EndedRun) -> Verdict:
            shows = form if judge_start(seen).status is Status.FAILED else following
            return judge_ending(seen.trace, seen.ending, shown_by=shows.id)

        return self.judged(judge, start)
