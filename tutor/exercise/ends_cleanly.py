"""A form: the process ends cleanly on Ctrl+C."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.launch_ending import judge_launch_ending
from tutor.exercise.launch_run import Launch
from tutor.exercise.nouns import LaunchFile, Program
from tutor.judge.bench import Bench, Scenario
from tutor.judge.check import Criterion
from tutor.judge.ending import judge_ending, repeat_chance_failures
from tutor.judge.trace import Ending, Trace
from tutor.judge.verdict import Status, Verdict
from tutor.judge.waiting_for_nodes import NO_NODE_S, START_S

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
        return await repeat_chance_failures(self._run)(bench)

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

    Of a `LaunchFile`, so does the whole launch, and no process is left. Judged on the start without parameters of the
    first criterion that makes one, or else on a start of its own. It is skipped where the process had ended before
    Ctrl+C, with the criterion that shows why. `start`: another scenario to judge it on, whose facts have `trace` and
    `ending`. `shown_by`: with `start`, the criterion that shows why the process had ended, if not the first one.
    """

    start: Scenario[Any] | None = None
    shown_by: Form | None = None

    def criterion(self, exercise: Exercise) -> Criterion:
        others = [form for form in exercise.forms if form is not self and not form.bonus]
        started = [(form, start) for form in others if (start := form.ended_start(exercise)) is not None]
        judge_end = judge_launch_ending if isinstance(exercise.started, LaunchFile) else judge_ending
        if not started or self.start is not None:
            shown_by, start = self.shown_by or [*others, self][0], self.start or _own_start(exercise.started)
            return self.judged(lambda seen: judge_end(seen.trace, seen.ending, shown_by=shown_by.id), start)
        start = started[0][1]
        sharing = [form for form, other in started if other == start]
        following = [*others[others.index(sharing[-1]) + 1 :], sharing[-1]][0]
        criteria = [form.criterion(exercise) for form in dict.fromkeys(_with_those_before(sharing))]
        scenarios = tuple(dict.fromkeys([start, *(facts for criterion in criteria for facts in criterion.facts)]))

        def judge(seen: EndedRun, *others_seen: Any) -> Verdict:
            found = dict(zip(scenarios, (seen, *others_seen), strict=True))
            failing = (
                criterion.id
                for criterion in criteria
                if criterion.judge(*(found[facts] for facts in criterion.facts)).status is Status.FAILED
            )
            shows = next(failing, following.id) if seen.ending is None else following.id
            return judge_end(seen.trace, seen.ending, shown_by=shows)

        return self.judged(judge, *scenarios)


def _with_those_before(forms: Iterable[Form]) -> Iterator[Form]:
    """Each of these forms, after those that must pass first and start nothing: one that is skipped shows nothing.

    What others start would have to be waited for.
    """
    for form in forms:
        before = (form.after,) if isinstance(form.after, Form) else form.after
        yield from (other for other in before if not other.starts_a_program)
        yield form


def _own_start(started: Program | LaunchFile) -> Scenario[Any]:
    return Launch(started) if isinstance(started, LaunchFile) else StartAndEnd(started)
