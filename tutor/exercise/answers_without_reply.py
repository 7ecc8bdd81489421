"""A form: a service answers also if the service that it asks is not there, or does not reply."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any, Literal

from tutor.exercise.answers_by_asking import describe_call, no_answer_in_words, not_offered
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
from tutor.exercise.nouns import Program
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import output_tail

Ours = Literal["missing", "silent"]
"""What is wrong with the service that the node asks: it is not there, or it does not reply."""

GONE_S = 0.7
"""Time after which a node knows that a server has gone, apart from any in which the machine did not let it run."""

GONE_LIMIT_S = 5.0
"""Time limit for that. A machine on which it takes longer is too busy."""

LATE_REPLY_S = 0.3
"""How long before the reply to the next call the one to the request that was given up is sent."""


@dataclass(frozen=True)
class UnrepliedRun(AskingRun):
    """A call without a reply, then calls with one, up to the first right answer; then one while our server has gone.

    `later`: the last call with a reply; None if the one before it was not answered as it should be, or the node never
    asked. `earlier`: what we replied to requests before it, even if too late. `gone`: the call after that; None if the
    one before it was not answered as it should be, or our server was there all the time.
    """

    later: AskingCall | None = None
    earlier: tuple[Mapping[str, Any], ...] = ()
    gone: AskingCall | None = None


@dataclass(frozen=True)
class CallWithoutReply:
    """Call the node while our server is not there, or does not reply; then once more, when it replies.

    A server that was not there goes away again, and the node is called a last time.
    """

    program: Program
    asking: Asking
    ours: Ours
    within_s: float

    async def __call__(self, bench: Bench) -> UnrepliedRun:
        async with bench.start(self.program.file, expected_s=self.within_s) as run:
            seen = await (self._call_silent(bench, run) if self.ours == "silent" else self._call_alone(bench, run))
        if seen.offered and seen.calls[-1].answer.response is None and seen.trace.exit is None:
            stuck = DumpWhileAsking(self.program, self.asking, "holds" if self.ours == "silent" else "missing")
            return replace(seen, stuck=await bench.facts(stuck))
        return seen

    async def _call_alone(self, bench: Bench, run: Run) -> UnrepliedRun:
        asking, service = self.asking, self.asking.service
        bench.report_progress(0.1, f"waiting for {service.name}, while there is no {asking.asks.name}")
        if not await wait_for_both(run, self.program, asking):
            return UnrepliedRun(run.trace(), offered=False)
        bench.report_progress(0.3, f"calling {service.name}, while there is no {asking.asks.name}")
        watch, later = BusyWatch(run), None
        call = await self._call_unserved(run)
        if answers_with(call.answer, asking.refusal):
            async with open_desk(run, asking) as desk:
                bench.report_progress(0.6, f"bringing up {asking.asks.name}")
                await wait_for_both(run, self.program, asking)
                later = await desk.reach()
        seen = self._seen(run, watch, call, later)
        return await self._call_once_gone(bench, run, seen) if later is not None and is_right(asking, later) else seen

    async def _call_unserved(self, run: Run) -> AskingCall:
        service, request = self.asking.service, self.asking.request(self.asking.requests[0])
        return AskingCall(await run.call(service.name, service.type, request, limit_s=self.within_s))

    async def _call_once_gone(self, bench: Bench, run: Run, seen: UnrepliedRun) -> UnrepliedRun:
        """Call once more, when the node can know that our server has gone; if it does not answer, see where it stays.

        If the machine does not let the node run, it may not know in time, and that explains a call without an answer.
        """
        bench.report_progress(0.8, f"calling {self.asking.service.name} once more, without {self.asking.asks.name}")
        since, waited_s = run.now(), run.node_cpu_wait_s() + run.our_cpu_wait_s()

        def can_know() -> bool:
            return run.now() - since - (run.node_cpu_wait_s() + run.our_cpu_wait_s() - waited_s) >= GONE_S

        knows, gone = await run.until(can_know, GONE_LIMIT_S), await self._call_unserved(run)
        trace, lost = run.trace(), gone.answer.response is None and run.exit is None
        slowed, stuck = seen.slowed or (lost and not knows), await run.dump_stacks() if lost else ()
        return replace(seen, trace=trace, gone=gone, slowed=slowed, stuck=stuck)

    async def _call_silent(self, bench: Bench, run: Run) -> UnrepliedRun:
        asking = self.asking
        async with open_desk(run, asking) as desk:
            bench.report_progress(0.1, f"waiting for {asking.service.name}")
            if not await wait_for_both(run, self.program, asking):
                return UnrepliedRun(run.trace(), offered=False)
            watch, first = BusyWatch(run), await desk.reach()
            if first.answer.response is None or not first.exchanges:
                return self._seen(run, watch, first, None)
            bench.report_progress(0.3, f"calling {asking.service.name}, without a reply on {asking.asks.name}")
            desk.replies_at_once = False
            call = await desk.call(asking.requests[1], self.within_s)
            if answers_with(call.answer, asking.refusal):
                bench.report_progress(0.8, f"replying on {asking.asks.name} again")
                later = await desk.call_and_hold(asking.requests[0], LATE_REPLY_S)
                return replace(self._seen(run, watch, call, later), earlier=self._earlier(desk, later))
            return self._seen(run, watch, call, None)

    def _earlier(self, desk: Desk, call: AskingCall) -> tuple[Mapping[str, Any], ...]:
        made = desk.with_exchanges(call.answer, -inf).exchanges
        return tuple(e.reply for e in made if e.reply is not None and e.at < call.answer.asked_at)

    def _seen(self, run: Run, watch: BusyWatch, call: AskingCall, later: AskingCall | None) -> UnrepliedRun:
        slowed = watch.is_to_blame(*(made for made in (call, later) if made is not None))
        return UnrepliedRun(run.trace(), slowed=slowed, calls=(call,), later=later)


@dataclass(frozen=True)
class AnswersWithoutReply(Form):
    """A service answers with a refusal if the service that it asks is not there, or does not reply; then it goes on.

    `ours`: "missing" or "silent". `within_s`: how long the answer may take, in seconds. Once the asked service is there
    and replies, the next call must be answered with its reply. If it was missing, it goes away again, and the call
    after that must be refused as well.
    """

    asking: Asking
    ours: Ours
    within_s: float = 5.0

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, CallWithoutReply(exercise.program, self.asking, self.ours, self.within_s))

    def judge(self, seen: UnrepliedRun) -> Verdict:
        """Judge the call without a reply, then those after it."""
        asking = self.asking
        name, asks = asking.service.name, asking.asks.name
        without = f"there is no {asks}" if self.ours == "missing" else f"{asks} does not reply"
        expected = (
            f"while {without}, {name} answers within {self.within_s:g} s with {asking.refused}; "
            f"once it replies, {name} passes that on"
        )
        if self.ours == "missing":
            expected = f"{expected}; once it has gone again, {name} answers as at first"
        tail = output_tail(seen.trace)
        if not seen.offered:
            if self.ours == "silent":
                return skipped(f"not judged, because there is no {name} to call")
            observed = f"while there is no {asks}, there is no {name} either"
            return failed(expected, observed, not_offered(asking, seen, alone=True), tail)
        call, later = seen.calls[-1], seen.later
        lines = [describe_call(asking, made) for made in (call, later, seen.gone) if made is not None]
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
            return failed(expected, observed, self._left_behind(seen, later), (*lines, *tail))
        if not is_right(asking, later):
            if seen.slowed and gave_up(asking, later):
                return undecided(f"to wait for the answer of {name}")
            got = dict(later.answer.response)
            says, do = f"{name} still answers {got} once {asks} replies", "Look again in each call who is there."
            if any(answers_with(later.answer, asking.right_answer(reply)) for reply in seen.earlier):
                says = f"{name} answers with what {asks} has replied to an earlier request"
                do = "Pair each reply with its own request: one that comes too late belongs to no other call."
            observed = f"answered while {without}; once it replies: answered {got}"
            return failed(expected, observed, self._wrong(seen, later, says, do), lines)
        if seen.gone is not None and not answers_with(seen.gone.answer, asking.refusal):
            return self._judge_gone(seen, seen.gone, expected, lines)
        return passed(expected, f"answered after {call.answer.took_s:.1f} s, and right later", lines)

    def _judge_gone(self, seen: UnrepliedRun, gone: AskingCall, expected: str, lines: Sequence[str]) -> Verdict:
        """Judge a call that was not refused though our server had gone."""
        asking = self.asking
        name, asks = asking.service.name, asking.asks.name
        observed = f"answered while there is no {asks}, and right later; once it has gone again"
        if gone.answer.response is None:
            if seen.slowed and seen.trace.exit is None:
                return undecided(f"to see what {name} does once {asks} has gone")
            observed = f"{observed}: {no_answer_in_words(asking, seen, gone)}"
            waits = self._waits(seen, gone, f"{name} waits for {asks}, which has gone again")
            return failed(expected, observed, waits, (*lines, *output_tail(seen.trace)))
        got = dict(gone.answer.response)
        says, do = f"{name} answers {got}, though {asks} has gone again", "Look again in each call who is there."
        return failed(expected, f"{observed}: answered {got}", self._wrong(seen, gone, says, do), lines)

    def _waits(self, seen: UnrepliedRun, call: AskingCall, still: str = "") -> Observation:
        """A call without a reply is not answered. `still`: what that says of one that is not the first."""
        name, asks = self.asking.service.name, self.asking.asks.name
        says, do = f"{name} waits for a reply of {asks} without a limit", "Set a limit to the wait, then say so."
        if self.ours == "silent" and not call.exchanges:
            says, do = f"{name} does not answer, and does not ask", f"Follow the callback of {name} to where it stays."
        if self.ours == "missing":
            says, do = f"{name} waits for {asks}, which is not there", "Look whether the service is there first."
        if still:
            says, do = still, "Look again in each call whether it is there: it may have gone since the last one."
        return self._no_answer(seen, call, says, do, self.ours)

    def _left_behind(self, seen: UnrepliedRun, call: AskingCall) -> Observation:
        """A call is not answered, though our server replies, after one that was refused."""
        name, asks = self.asking.service.name, self.asking.asks.name
        if call.replies:
            says = f"{asks} has replied again, and {name} does not answer all the same"
            do = "Look at what takes in the reply while the callback waits for it, and what the last call has left."
        else:
            says = f"after a call without a reply of {asks}, {name} does not answer the next one, and does not ask"
            do = "Look at what a call leaves behind when it is given up, and what the next one waits for."
        return self._no_answer(seen, call, says, do)

    def _no_answer(self, seen: UnrepliedRun, call: AskingCall, says: str, do: str, ours: str = "") -> Observation:
        asking = self.asking
        name, asks = asking.service.name, asking.asks.name
        if seen.trace.exit is not None:
            says, do = f"the node ends while {name} has no reply", "Answer in that case too, and go on."
        return seen.symptom(
            Symptom.NO_ANSWER,
            service=name,
            type=asking.service.type,
            services=(name,) if ours == "missing" and not call.exchanges else (name, asks),
            asks=asks,
            asked=bool(call.exchanges),
            replied=bool(call.replies),
            ours=ours,
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
