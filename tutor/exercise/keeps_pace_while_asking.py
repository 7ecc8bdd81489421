"""A form: a topic of the node keeps its rate during a call of a service that waits for a reply."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf
from typing import Literal

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
from tutor.judge.trace import CallAnswer
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

Part = Literal["before it asks", "while it waits", "after the reply"]
"""A part of the call."""


@dataclass(frozen=True)
class Pace:
    """The messages on a topic during a call that took `for_s` seconds. `longest_s`: the longest pause.

    `cpu_wait_s`: how long the node has waited for a CPU meanwhile. `pauses`: the part of the call in which most of the
    longest pause is.
    """

    count: int
    for_s: float
    longest_s: float
    cpu_wait_s: float = 0.0
    pauses: Part = "while it waits"

    def is_right(self, hz: float, allowance_s: float = 0.0) -> bool:
        """Whether they come at this rate, and without a pause; both may be off by what fits into `allowance_s`."""
        least, most = (1 - TOLERANCE) * hz * self.for_s - 1, (1 + TOLERANCE) * hz * self.for_s + 1
        too_many_or_few = max(least - self.count, self.count - most)
        return not self.has_pause(hz, allowance_s) and too_many_or_few <= allowance_s * hz

    def has_pause(self, hz: float, allowance_s: float = 0.0) -> bool:
        """Whether the longest pause is too long at this rate, and by more than this allowance."""
        return self.longest_s > 3 / hz + SLACK_S + allowance_s

    def may_be_right(self, hz: float) -> bool:
        """Whether the machine alone may be to blame for a wrong pace: a node that waits also catches up later."""
        slowed = self.cpu_wait_s >= HARDLY_WAITED_SHARE * self.for_s
        return slowed and self.is_right(hz, allowance_s=2 * self.cpu_wait_s)

    @property
    def stops(self) -> bool:
        """Whether the topic stands still for most of the call."""
        return self.longest_s >= BLOCKED_SHARE * self.for_s

    def __str__(self) -> str:
        return f"{counted(self.count, 'message')} in {self.for_s:.1f} s, the longest pause {self.longest_s:.2f} s"


def measure_pace(times: Sequence[float], answer: CallAnswer, asked_at: float, replied_at: float) -> Pace:
    """The pace of messages with these source times, in their order, from the call until its answer.

    `asked_at`, `replied_at`: when our server was asked, and replied. That is the end if there was no answer.
    """
    since, until = answer.asked_at, replied_at if answer.response is None else max(answer.answered_at, replied_at)
    within = [time for time in times if since <= time <= until]
    last = [time for time in times if time < since][-1:]
    longest = max(pairwise([*(last or [since]), *within, until]), key=lambda pause: pause[1] - pause[0])
    parts: dict[Part, tuple[float, float]] = {
        "while it waits": (asked_at, replied_at),
        "before it asks": (-inf, asked_at),
        "after the reply": (replied_at, inf),
    }
    pauses = max(parts, key=lambda part: min(longest[1], parts[part][1]) - max(longest[0], parts[part][0]))
    return Pace(len(within), until - since, longest[1] - longest[0], pauses=pauses)


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
        """Call the node, hold back the reply, and watch the topic until the answer; None if the node did not ask."""
        before, began, waited_s = len(desk.requests), run.now(), run.node_cpu_wait_s()
        async with Tasks() as tasks:
            calling = tasks.start(desk.call_unreplied(given, self.hold_s + ANSWER_S))
            await run.until(lambda: len(desk.requests) > before or calling.done(), ANSWER_S)
            asked_at = desk.requests[before].at if len(desk.requests) > before else None
            if asked_at is not None:
                await run.until(lambda: run.now() >= asked_at + self.hold_s, self.hold_s)
            replied_at = run.now()
            desk.reply(*desk.held)
            desk.replies_at_once = True
            answer = await calling
        if asked_at is None:
            return desk.with_exchanges(answer, began), None
        waited_s, until, late_s = run.node_cpu_wait_s() - waited_s, run.now(), run.our_cpu_wait_s()
        await run.until(lambda: run.now() >= until + IN_FLIGHT_S + run.our_cpu_wait_s() - late_s, 1.0)
        times = sorted(sample.source_time for sample in run.samples_on(self.topic.name))
        pace = replace(measure_pace(times, answer, asked_at, replied_at), cpu_wait_s=waited_s)
        return desk.with_exchanges(answer, began), pace


@dataclass(frozen=True)
class KeepsPaceWhileAsking(Form):
    """A topic keeps its rate during a call, from the request to the answer, while the node waits for a reply itself.

    `topic`, `hz`: what the node publishes, whether called or not. `hold_s`: for how long the reply of the service that
    the node asks is held back, in seconds; take a time after which nobody gives up yet. Judged after the exercise's
    `AnswersByAsking`, if it has one.
    """

    asking: Asking
    topic: Topic
    hz: float
    hold_s: float = 1.5

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, HoldReply(exercise.program, self.asking, self.topic, self.hz, self.hold_s))

    def judge(self, seen: PaceRun) -> Verdict:
        """Judge the pace during the call whose reply was held back."""
        asking, topic = self.asking, self.topic
        expected = f"{topic.name} at {self.hz:g} Hz, also during a call of {asking.service.name}, until it is answered"
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
        observed = f"during a call: {pace}"
        if seen.trace.exit is not None:
            observed = f"{observed}; then the process ended by itself with {seen.trace.exit}"
            return failed(expected, observed, no_answer(asking, seen, call), tail)
        if pace.is_right(self.hz):
            return passed(expected, f"while nobody calls: {seen.rate}; {observed}")
        if pace.may_be_right(self.hz):
            return undecided(f"to watch {topic.name}")
        says, do = self._words(pace)
        still = seen.symptom(
            Symptom.STANDS_STILL,
            service=asking.service.name,
            stops=pace.stops,
            pause_s=pace.longest_s,
            says=says,
            do=do,
            **about,
        )
        return failed(expected, observed, still, tail)

    def _words(self, pace: Pace) -> tuple[str, str]:
        """What a wrong pace says, and what to do about it: a pause may also come before the wait, or after it."""
        topic, service, asks = self.topic.name, self.asking.service.name, self.asking.asks.name
        if pace.has_pause(self.hz) and pace.pauses == "before it asks":
            says = f"{topic} stops before {service} asks {asks}"
            return says, "Look at what the callback does before it asks, and for how long that keeps the timer waiting."
        if pace.has_pause(self.hz) and pace.pauses == "after the reply":
            says = f"{topic} stops after {asks} has replied, until {service} answers"
            return says, "Look at what the callback does with the reply, and for how long that keeps the timer waiting."
        says = f"{topic} {'stops' if pace.has_pause(self.hz) else 'does not keep its rate'} while {service} waits"
        do = "Look at what the waiting callback keeps busy: the executor's thread, or the timer's callback group."
        return f"{says} for a reply", do
