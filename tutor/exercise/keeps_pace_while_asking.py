"""A form: a topic of the node keeps its rate while a service of the node waits for a reply."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from tutor.exercise.answers_by_asking import no_answer, no_answer_in_words
from tutor.exercise.asking import Asking, AskingCall, AskingRun, Desk, DumpWhileAsking, open_desk, wait_for_both
from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program, Topic
from tutor.exercise.service_calls import ANSWER_S
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.rates import TOLERANCE, Rate, describe
from tutor.judge.symptom import Symptom
from tutor.judge.tasks import Tasks
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.waiting_for_nodes import (
    HARDLY_WAITED_SHARE,
    IN_FLIGHT_S,
    measure_steady_rate,
    wait_for_message,
)
from tutor.judge.wording import counted, output_tail

SLACK_S = 0.3
"""A pause of this much more than three periods is no jitter."""

TRIES = 3
"""How often a reply is held back while the machine may be to blame for what was seen."""

BLOCKED_SHARE = 0.75
"""A topic that pauses for less than this share of the wait does not stand still for all of it."""


@dataclass(frozen=True)
class Pace:
    """The messages on a topic while a reply was held back for `for_s` seconds. `longest_s`: the longest pause.

    `cpu_wait_s`: how long the node has waited for a CPU meanwhile.
    """

    count: int
    for_s: float
    longest_s: float
    cpu_wait_s: float = 0.0

    def is_right(self, hz: float, allowance_s: float = 0.0) -> bool:
        """Whether they come at this rate, and without a pause; both may be off by what fits into `allowance_s`."""
        least, most = (1 - TOLERANCE) * hz * self.for_s - 1, (1 + TOLERANCE) * hz * self.for_s + 1
        too_many_or_few = max(least - self.count, self.count - most)
        return self.longest_s <= 3 / hz + SLACK_S + allowance_s and too_many_or_few <= allowance_s * hz

    def may_be_right(self, hz: float) -> bool:
        """Whether the machine alone may be to blame for a wrong pace: a node that waits also catches up later."""
        slowed = self.cpu_wait_s >= HARDLY_WAITED_SHARE * self.for_s
        return slowed and self.is_right(hz, allowance_s=2 * self.cpu_wait_s)

    @property
    def stops(self) -> bool:
        """Whether the topic stands still for most of the wait."""
        return self.longest_s >= BLOCKED_SHARE * self.for_s

    def __str__(self) -> str:
        return f"{counted(self.count, 'message')} in {self.for_s:.1f} s, the longest pause {self.longest_s:.2f} s"


@dataclass(frozen=True)
class PaceRun(AskingRun):
    """`rate`, of `messages`: while nobody called. `pace`: in the last call whose reply was held back, if one was."""

    rate: Rate | None = None
    messages: int = 0
    pace: Pace | None = None


@dataclass(frozen=True)
class HoldReply:
    """Measure a topic, first while nobody calls, then while the node waits for our reply."""

    program: Program
    asking: Asking
    topic: Topic
    hz: float
    hold_s: float

    async def __call__(self, bench: Bench) -> PaceRun:
        asking, topic, calls = self.asking, self.topic, list[AskingCall]()
        async with (
            bench.start(self.program.file, watch=topic.watched, expected_s=3.5) as run,
            open_desk(run, asking) as desk,
        ):
            bench.report_progress(0.1, f"waiting for {asking.service.name} and {topic.name}")
            rate, messages, pace = None, 0, None
            offered = await wait_for_both(run, self.program, asking)
            if await wait_for_message(run, topic.name, topic.type):
                rate, messages = await measure_steady_rate(run, topic.name, self.hz, since=run.now())
            if offered and rate is not None and rate.agrees_with(self.hz):
                calls.append(await desk.reach())
            while calls and calls[-1].exchanges and calls[-1].answer.response is not None and len(calls) <= TRIES:
                bench.report_progress(0.5, f"holding back the reply on {asking.asks.name}")
                call, pace = await self._hold(run, desk, asking.requests[len(calls) % len(asking.requests)])
                calls.append(call)
                if pace is None or pace.is_right(self.hz) or not pace.may_be_right(self.hz):
                    break
            answers = rate is not None or await run.parameters(ANSWER_S) is not None
            found = PaceRun(
                run.trace(), answers, offered=offered, calls=tuple(calls), rate=rate, messages=messages, pace=pace
            )
        if pace is not None and not pace.is_right(self.hz) and found.trace.exit is None:
            stuck = await bench.facts(DumpWhileAsking(self.program, asking, "holds"))
            return PaceRun(**{**vars(found), "stuck": stuck})
        return found

    async def _hold(self, run: Run, desk: Desk, given: tuple[object, ...]) -> tuple[AskingCall, Pace | None]:
        """Call the node, hold back the reply, and watch the topic meanwhile; None if the node did not ask."""
        before, began = len(desk.requests), run.now()
        async with Tasks() as tasks:
            calling = tasks.start(desk.call_unreplied(given, self.hold_s + ANSWER_S))
            await run.until(lambda: len(desk.requests) > before or calling.done(), ANSWER_S)
            pace = None
            if len(desk.requests) > before:
                since, waited_s = desk.requests[before].at, run.node_cpu_wait_s()
                await run.until(lambda: run.now() >= since + self.hold_s, self.hold_s)
                until, late_s = run.now(), run.our_cpu_wait_s()
                await run.until(lambda: run.now() >= until + IN_FLIGHT_S + run.our_cpu_wait_s() - late_s, 1.0)
                pace = self._measure(run, since, until, run.node_cpu_wait_s() - waited_s)
            desk.reply(*desk.held)
            desk.replies_at_once = True
            return desk.with_exchanges(await calling, began), pace

    def _measure(self, run: Run, since: float, until: float, cpu_wait_s: float) -> Pace:
        times = sorted(sample.source_time for sample in run.samples_on(self.topic.name))
        within = [time for time in times if since <= time <= until]
        last = [time for time in times if time < since][-1:]
        pauses = [b - a for a, b in pairwise([*last, *within, until])]
        return Pace(len(within), until - since, max(pauses, default=until - since), cpu_wait_s)


@dataclass(frozen=True)
class KeepsPaceWhileAsking(Form):
    """A topic keeps its rate while the node waits for the reply of the service that it asks.

    `topic`, `hz`: what the node publishes, whether called or not. `hold_s`: for how long the reply is held back, in
    seconds; take a time after which nobody gives up yet. Judged after the exercise's `AnswersByAsking`, if it has one.
    """

    asking: Asking
    topic: Topic
    hz: float
    hold_s: float = 1.5

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, HoldReply(exercise.program, self.asking, self.topic, self.hz, self.hold_s))

    def judge(self, seen: PaceRun) -> Verdict:
        """Judge the pace while the reply was held back."""
        asking, topic = self.asking, self.topic
        expected = f"{topic.name} at {self.hz:g} Hz, also while {asking.service.name} waits for {asking.asks.name}"
        tail = output_tail(seen.trace)
        about = {"topic": topic.name, "type": topic.type, "wanted_hz": self.hz, "rate": seen.rate}
        if seen.rate is None:
            missing = seen.symptom(Symptom.NO_MESSAGES, some=seen.messages > 0, **about)
            return failed(expected, f"{topic.name}: {describe(None, seen.messages)}", missing, tail)
        if not seen.rate.agrees_with(self.hz):
            wrong = seen.symptom(Symptom.WRONG_RATE, inverted=seen.rate.agrees_with(1 / self.hz), **about)
            return failed(expected, f"while nobody calls: {seen.rate}", wrong, tail)
        if not seen.offered or not seen.calls:
            return skipped(f"not judged, because there is no {asking.service.name} to call")
        call, pace = seen.calls[-1], seen.pace
        if pace is None:
            if call.answer.response is None:
                return failed(expected, no_answer_in_words(asking, seen, call), no_answer(asking, seen, call), tail)
            return skipped(f"not judged, because {asking.service.name} does not ask {asking.asks.name}")
        observed = f"while it waits: {pace}"
        if seen.trace.exit is not None:
            observed = f"{observed}; then the process ended by itself with {seen.trace.exit}"
            return failed(expected, observed, no_answer(asking, seen, call), tail)
        if pace.is_right(self.hz):
            return passed(expected, f"while nobody calls: {seen.rate}; {observed}")
        if pace.may_be_right(self.hz):
            return undecided(f"to watch {topic.name}")
        still = seen.symptom(
            Symptom.STANDS_STILL,
            service=asking.service.name,
            stops=pace.stops,
            pause_s=pace.longest_s,
            says=f"{topic.name} stops while {asking.service.name} waits for a reply",
            do="Look at what the waiting callback keeps busy: the executor's thread, or the timer's callback group.",
            **about,
        )
        return failed(expected, observed, still, tail)
