"""A form: a service answers also if the service that it asks is not there, or does not reply."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tutor.exercise.answers_by_asking import describe_call, no_answer_in_words, not_offered
from tutor.exercise.asking import (
    Asking,
    AskingCall,
    AskingRun,
    BusyWatch,
    DumpWhileAsking,
    answers_with,
    gave_up,
    is_right,
    open_desk,
    wait_for_both,
)
from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import output_tail

Ours = Literal["missing", "silent"]
"""What is wrong with the service that the node asks: it is not there, or it does not reply."""


@dataclass(frozen=True)
class UnrepliedRun(AskingRun):
    """A call without a reply, then calls with one, up to the first right answer.

    `later`: the last of these; None if the one before it was not answered as it should be, or the node never asked.
    """

    later: AskingCall | None = None


@dataclass(frozen=True)
class CallWithoutReply:
    """Call the node while our server is not there, or does not reply; then once more, when it replies."""

    program: Program
    asking: Asking
    ours: Ours
    within_s: float

    async def __call__(self, bench: Bench) -> UnrepliedRun:
        async with bench.start(self.program.file, expected_s=self.within_s) as run:
            seen = await (self._call_silent(bench, run) if self.ours == "silent" else self._call_alone(bench, run))
        if seen.offered and seen.calls[-1].answer.response is None and seen.trace.exit is None:
            stuck = DumpWhileAsking(self.program, self.asking, "holds" if self.ours == "silent" else "missing")
            return UnrepliedRun(**{**vars(seen), "stuck": await bench.facts(stuck)})
        return seen

    async def _call_alone(self, bench: Bench, run: Run) -> UnrepliedRun:
        asking, service = self.asking, self.asking.service
        bench.report_progress(0.1, f"waiting for {service.name}, while there is no {asking.asks.name}")
        if not await wait_for_both(run, self.program, asking):
            return UnrepliedRun(run.trace(), offered=False)
        bench.report_progress(0.3, f"calling {service.name}, while there is no {asking.asks.name}")
        watch, later = BusyWatch(run), None
        request = asking.request(asking.requests[0])
        call = AskingCall(await run.call(service.name, service.type, request, limit_s=self.within_s))
        if answers_with(call.answer, asking.refusal):
            async with open_desk(run, asking) as desk:
                bench.report_progress(0.6, f"bringing up {asking.asks.name}")
                await wait_for_both(run, self.program, asking)
                later = await desk.reach()
        return self._seen(run, watch, call, later)

    async def _call_silent(self, bench: Bench, run: Run) -> UnrepliedRun:
        asking = self.asking
        async with open_desk(run, asking) as desk:
            bench.report_progress(0.1, f"waiting for {asking.service.name}")
            if not await wait_for_both(run, self.program, asking):
                return UnrepliedRun(run.trace(), offered=False)
            watch, later, first = BusyWatch(run), None, await desk.reach()
            if first.answer.response is None or not first.exchanges:
                return self._seen(run, watch, first, None)
            bench.report_progress(0.3, f"calling {asking.service.name}, without a reply on {asking.asks.name}")
            desk.replies_at_once = False
            call = await desk.call(asking.requests[1], self.within_s)
            if answers_with(call.answer, asking.refusal):
                bench.report_progress(0.8, f"replying on {asking.asks.name} again")
                desk.replies_at_once = True
                later = await desk.call(asking.requests[0])
            return self._seen(run, watch, call, later)

    def _seen(self, run: Run, watch: BusyWatch, call: AskingCall, later: AskingCall | None) -> UnrepliedRun:
        slowed = watch.is_to_blame(*(made for made in (call, later) if made is not None))
        return UnrepliedRun(run.trace(), slowed=slowed, calls=(call,), later=later)


@dataclass(frozen=True)
class AnswersWithoutReply(Form):
    """A service answers with a refusal if the service that it asks is not there, or does not reply; then it goes on.

    `ours`: "missing" or "silent". `within_s`: how long the answer may take, in seconds. Once the asked service is there
    and replies, the next call must be answered with its reply.
    """

    asking: Asking
    ours: Ours
    within_s: float = 5.0

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, CallWithoutReply(exercise.program, self.asking, self.ours, self.within_s))

    def judge(self, seen: UnrepliedRun) -> Verdict:
        """Judge the call without a reply, then the one after it."""
        asking = self.asking
        name, asks = asking.service.name, asking.asks.name
        without = f"there is no {asks}" if self.ours == "missing" else f"{asks} does not reply"
        expected = (
            f"while {without}, {name} answers within {self.within_s:g} s with {asking.refused}; "
            f"once it replies, {name} passes that on"
        )
        tail = output_tail(seen.trace)
        if not seen.offered:
            if self.ours == "silent":
                return skipped(f"not judged, because there is no {name} to call")
            observed = f"while there is no {asks}, there is no {name} either"
            return failed(expected, observed, not_offered(asking, seen, alone=True), tail)
        call, later = seen.calls[-1], seen.later
        lines = [describe_call(asking, made) for made in (call, later) if made is not None]
        if call.answer.response is None:
            observed = f"while {without}: {no_answer_in_words(asking, seen, call)}"
            return failed(expected, observed, self._waits(seen, call), tail)
        if not answers_with(call.answer, asking.refusal):
            got = dict(call.answer.response)
            says = f"while {without}, {name} answers {got}"
            do = f"Look for what says that no reply has come, and answer with {asking.refused}."
            return failed(expected, f"while {without}: answered {got}", self._wrong(seen, call, says, do), lines)
        if later is None:
            return skipped(f"not judged, because {name} has not asked {asks} before")
        if later.answer.response is None:
            observed = f"answered while {without}; once it replies: {no_answer_in_words(asking, seen, later)}"
            return failed(expected, observed, self._waits(seen, later), (*lines, *tail))
        if not is_right(asking, later):
            if seen.slowed and gave_up(asking, later):
                return undecided(f"to wait for the answer of {name}")
            got = dict(later.answer.response)
            says, do = f"{name} still answers {got} once {asks} replies", "Look again in each call who is there."
            observed = f"answered while {without}; once it replies: answered {got}"
            return failed(expected, observed, self._wrong(seen, later, says, do), lines)
        return passed(expected, f"answered after {call.answer.took_s:.1f} s, and right later", lines)

    def _waits(self, seen: UnrepliedRun, call: AskingCall) -> Observation:
        asking = self.asking
        name, asks = asking.service.name, asking.asks.name
        says, do = f"{name} waits for a reply of {asks} without a limit", "Set a limit to the wait, then say so."
        if self.ours == "missing":
            says, do = f"{name} waits for {asks}, which is not there", "Look whether the service is there first."
        if seen.trace.exit is not None:
            says, do = f"the node ends while {name} has no reply", "Answer in that case too, and go on."
        return seen.symptom(
            Symptom.NO_ANSWER,
            service=name,
            type=asking.service.type,
            services=(name,) if self.ours == "missing" and not call.exchanges else (name, asks),
            asks=asks,
            asked=bool(call.exchanges),
            replied=bool(call.replies),
            ours=self.ours,
            says=says,
            do=do,
        )

    def _wrong(self, seen: UnrepliedRun, call: AskingCall, says: str, do: str) -> Observation:
        about = {"service": self.asking.service.name, "type": self.asking.service.type, "asks": self.asking.asks.name}
        return seen.symptom(
            Symptom.WRONG_ANSWER,
            answer=call.answer,
            ours=self.ours,
            asked=bool(call.exchanges),
            says=says,
            do=do,
            **about,
        )
