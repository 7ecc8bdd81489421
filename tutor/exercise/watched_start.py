"""Forms that only watch a start without parameters: the start that they share, and what is logged in it.

Each of them is judged on what was seen until its own time was over; for those about messages, see `publishes`.
"""

from __future__ import annotations

import asyncio
import re
from abc import abstractmethod
from dataclasses import dataclass, field, replace
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.node_parameters import DumpSilentNode
from tutor.exercise.nouns import Program
from tutor.exercise.publishing_start import cancel
from tutor.exercise.seen_run import Seen, look
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending, Level, LogRecord, Trace
from tutor.judge.verdict import Status, Verdict, failed, passed
from tutor.judge.waiting_for_nodes import wait_until_seen
from tutor.judge.wording import counted, output_tail

LOG_DELAY_S = 0.5
"""Upper bound on the latency of a log message, apart from our own wait for a CPU."""


@dataclass(frozen=True)
class WatchedStart:
    """A start without parameters, ended with Ctrl+C once all has been seen.

    `seen`: in the order of the forms, what each has seen when its time was over, or None as long as it is not.
    """

    seen: tuple[Seen | None, ...]
    trace: Trace
    ending: Ending | None = None

    @property
    def slowed(self) -> bool:
        """Whether the machine may be to blame for what some form has not seen (see `tutor.judge.bench.was_slowed`)."""
        return any(seen is not None and seen.slowed for seen in self.seen)


@dataclass(frozen=True)
class Watch:
    """Start without parameters, watch until the time of each form is over, and press Ctrl+C."""

    program: Program
    forms: tuple[Watching, ...]

    async def __call__(self, bench: Bench) -> WatchedStart:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> WatchedStart:
        seen: list[Seen | None] = [None] * len(self.forms)
        silent = DumpSilentNode(self.program)  # others still watch the run itself
        topics = {name: kind for form in self.forms for name, kind in form.watched.items()}

        async def watch(number: int, form: Watching, run: Run) -> None:
            does_nothing = not await form.watch(run)
            seen[number] = await look(run, does_nothing=does_nothing, dump=lambda: bench.facts(silent))
            bench.report_facts(WatchedStart(tuple(seen), run.trace()))

        expected_s = max(form.within_s for form in self.forms)
        async with bench.start(self.program.file, watch=topics, expected_s=expected_s) as run:
            bench.report_progress(0.2, "watching what it does")
            tasks = [asyncio.ensure_future(watch(number, form, run)) for number, form in enumerate(self.forms)]
            try:
                await asyncio.gather(*tasks)
            finally:
                await cancel(tasks)
            trace = run.trace()
            bench.report_progress(0.8, "pressing Ctrl+C")
            return WatchedStart(tuple(seen), trace, await run.interrupt())


@dataclass(frozen=True)
class Watching(Form):
    """A criterion that is judged on the start that all forms of this kind watch."""

    within_s: float = field(default=5.0, kw_only=True)

    def criterion(self, exercise: Exercise) -> Criterion:
        start = self.ended_start(exercise)
        number = start.forms.index(self._alone)

        def judge_early(facts: object) -> Verdict | None:
            seen = facts.seen[number] if isinstance(facts, WatchedStart) else None
            verdict = self.judge_seen(seen) if seen is not None and not seen.slowed else None
            return verdict if verdict is not None and verdict.status is Status.FAILED else None

        def judge(facts: WatchedStart) -> Verdict:
            seen = facts.seen[number]
            assert seen is not None
            return self.judge_seen(seen)

        return self.judged(judge, start, early=judge_early)

    def ended_start(self, exercise: Exercise) -> Watch:
        return Watch(exercise.program, tuple(form._alone for form in exercise.forms if isinstance(form, Watching)))

    @property
    def _alone(self) -> Watching:
        """The form as a value of its own, whatever it is `after`."""
        return replace(self, after=(), bonus=False)

    @property
    def watched(self) -> dict[str, str]:
        """The topics that it looks at, with their types."""
        return {}

    @abstractmethod
    async def watch(self, run: Run) -> bool:
        """Wait until it is decided; return whether the node has done anything of what was waited for."""

    @abstractmethod
    def judge_seen(self, seen: Seen) -> Verdict:
        """Judge what was seen until then."""


@dataclass(frozen=True)
class LogsText(Watching):
    """The node logs a text soon after it has started: with its logger, not with print().

    `text`: a part of the message, whatever the case; or a compiled pattern, which is searched for. `severity`: the
    lowest that counts, "debug" to "fatal". `within_s`: how long it may take once the node is there, in seconds.

        LogsText("warns", re.compile(r"battery.*low"), severity="warn", within_s=10)

    Raises ValueError for an unknown severity.
    """

    text: str | re.Pattern[str]
    severity: str = "debug"

    def __post_init__(self) -> None:
        if self.severity.upper() not in Level.__members__:
            names = ", ".join(level.name.lower() for level in Level)
            raise ValueError(f"{self.id}: {self.severity!r} is no severity: take one of {names}")

    async def watch(self, run: Run) -> bool:
        def is_logged() -> bool:
            return self._find(run.logs) is not None

        limit_s = self.within_s + LOG_DELAY_S
        return await wait_until_seen(run, is_logged, promised=lambda: True, message_gap_s=limit_s) or bool(run.logs)

    def judge_seen(self, seen: Seen) -> Verdict:
        what = repr(self.text if isinstance(self.text, str) else self.text.pattern)
        least = f" at {self.severity.upper()} or above" if self.severity != "debug" else ""
        expected = f"a log message with {what}{least}, within {self.within_s:g} s"
        logs = seen.trace.logs
        if (found := self._find(logs)) is not None:
            return passed(expected, "it is logged", [str(found)])
        lower = next((log for log in logs if self.is_in(log.text)), None)
        says, do = f"no log message contains {what}", f"Log {what} with the node's own logger."
        observed = f"in none of {counted(len(logs), 'log message')}"
        if lower is not None:
            observed = str(lower)
            says = f"{what} is logged, but not{least}"
            do = f"Log it with the logger's method for {self.severity.upper()}."
        missing = seen.symptom(Symptom.NOT_LOGGED, what=what, recognise=self.is_in, says=says, do=do)
        return failed(expected, observed, missing, [str(log) for log in logs[-3:]] or output_tail(seen.trace))

    def is_in(self, text: str) -> bool:
        """Whether a message has the text."""
        return text_in(text, self.text)

    def _find(self, logs: Any) -> LogRecord | None:
        least = Level[self.severity.upper()]
        return next((log for log in logs if log.level >= least and self.is_in(log.text)), None)


def text_in(text: str, wanted: str | re.Pattern[str]) -> bool:
    """Whether a text contains another, whatever the case, or a pattern."""
    return wanted.casefold() in text.casefold() if isinstance(wanted, str) else wanted.search(text) is not None
