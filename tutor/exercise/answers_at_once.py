"""A form: two calls at once are both answered, each with the reply to its own request."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from tutor.exercise.answers_by_asking import GIVE_UPS, describe_call, no_answer, no_answer_in_words, what_is_wrong
from tutor.exercise.asking import (
    Asking,
    AskingCall,
    AskingRun,
    BusyWatch,
    Desk,
    DumpWhileAsking,
    answers_with,
    gave_up,
    is_right,
    open_desk,
    wait_for_both,
)
from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program, agrees
from tutor.exercise.service_calls import ANSWER_S
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.tasks import Tasks
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import output_tail

SECOND_S = 1.5
"""How long the first request is held back for a second one to come: a node may also ask for one after the other.

A second call that does not wait for its turn as long as a reply may take is refused meanwhile."""


@dataclass(frozen=True)
class CalledAtOnce(AskingRun):
    """Two calls at once. `overlapped`: whether both requests had reached us before we replied to any."""

    overlapped: bool = False


@dataclass(frozen=True)
class CallAtOnce:
    """Call the node twice at once; reply to the request that came last first, if both are there."""

    program: Program
    asking: Asking

    async def __call__(self, bench: Bench) -> CalledAtOnce:
        asking = self.asking
        async with bench.start(self.program.file, expected_s=2.0) as run, open_desk(run, asking) as desk:
            bench.report_progress(0.1, f"waiting for {asking.service.name}")
            if not await wait_for_both(run, self.program, asking):
                return CalledAtOnce(run.trace(), offered=False)
            watch, first = BusyWatch(run), await desk.reach()
            if first.answer.response is None or not first.exchanges:
                return CalledAtOnce(run.trace(), slowed=watch.is_to_blame(first), calls=(first,))
            bench.report_progress(0.4, f"calling {asking.service.name} twice at once")
            calls, overlapped, slowed = await self.call_until_sure(run, desk, watch)
            lost = any(call.answer.response is None for call in calls)
            trace = run.trace()
        stuck = await bench.facts(DumpWhileAsking(self.program, asking, "holds")) if lost and not trace.exit else ()
        return CalledAtOnce(trace, True, stuck, slowed, calls=calls, overlapped=overlapped)

    async def call_until_sure(
        self, run: Run, desk: Desk, watch: BusyWatch
    ) -> tuple[tuple[AskingCall, ...], bool, bool]:
        """Call twice at once, and again while the machine may be to blame for giving up one of both.

        Returns the last two calls, whether they overlapped, and whether the machine may be to blame for what they got:
        not if one of both is given up each time.
        """
        for _ in range(GIVE_UPS):
            calls, overlapped = await self._call_twice(run, desk)
            slowed = watch.is_to_blame(*calls)
            if not slowed or not any(gave_up(self.asking, call) for call in calls):
                return calls, overlapped, slowed
        return calls, overlapped, False

    async def _call_twice(self, run: Run, desk: Desk) -> tuple[tuple[AskingCall, ...], bool]:
        before, began = len(desk.requests), run.now()
        async with Tasks() as tasks:
            calls = [
                tasks.start(desk.call_unreplied(given, 2 * ANSWER_S + SECOND_S)) for given in self.asking.requests[:2]
            ]
            await run.until(lambda: len(desk.requests) > before or tasks.count_done() > 0, ANSWER_S)
            await run.until(lambda: len(desk.requests) > before + 1 or tasks.count_done() > 0, SECOND_S)
            overlapped = len(desk.held) > 1
            desk.reply(*reversed(desk.held))
            desk.replies_at_once = True
            return tuple([self._own(desk.with_exchanges(await call, began)) for call in calls]), overlapped

    def _own(self, call: AskingCall) -> AskingCall:
        """The call with what was asked for it: its requests are told from those of the other call by their fields."""
        own = self.asking.passed_on(call.answer.request)
        return replace(call, exchanges=tuple(made for made in call.exchanges if agrees(made.asked, own)))


@dataclass(frozen=True)
class AnswersAtOnce(Form):
    """Two calls at once are both answered, each with what the asked service has replied to its own request.

    Whether the node asks for both at once, or for one after the other, is left to it; see `Asking`.
    """

    asking: Asking

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, CallAtOnce(exercise.program, self.asking))

    def judge(self, seen: CalledAtOnce) -> Verdict:
        """Judge both calls."""
        asking = self.asking
        name, asks = asking.service.name, asking.asks.name
        if not seen.offered:
            return skipped(f"not judged, because there is no {name} to call")
        expected = f"two calls of {name} at once are both answered, each with what {asks} has replied to it"
        lines = [describe_call(asking, call) for call in seen.calls]
        for call in seen.calls:
            if call.answer.response is None:
                why = no_answer(asking, seen, call, at_once=len(seen.calls))
                observed = no_answer_in_words(asking, seen, call)
                return failed(expected, observed, why, (*lines, *output_tail(seen.trace)))
        for call in seen.calls:
            if not is_right(asking, call):
                if seen.slowed and gave_up(asking, call):
                    return undecided(f"to wait for the answer of {name}")
                others = [reply for other in seen.calls for reply in other.replies]
                observed, why = what_is_wrong(asking, seen, call, beside=True, shared=self._shared(call, others))
                return failed(expected, observed, why, lines)
        how = "both asked for at once" if seen.overlapped else "one asked for after the other"
        return passed(expected, f"both answered; {how}", lines)

    def _shared(self, call: AskingCall, replies: Sequence[Mapping[str, Any]]) -> str:
        """With what a call was answered wrongly, if that is the reply to another call, or nothing at all."""
        assert call.answer.response is not None
        if any(answers_with(call.answer, self.asking.right_answer(reply)) for reply in replies):
            return "the result of another that was made at the same time"
        empty = not any(call.answer.response.values())
        return "nothing filled in, since another was made at the same time" if empty else ""
