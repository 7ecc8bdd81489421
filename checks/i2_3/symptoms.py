"""I2.3: what a criterion saw go wrong, for the catalogue of mistakes."""

from __future__ import annotations

from collections import Counter

from checks.i2_3.facts import (
    SEQUENTIAL_RATIO,
    SERVICE,
    SHORTEST_S,
    TYPE,
    WORK_S,
    CallBatch,
    IdleRun,
    SingleCalls,
    right_sum,
)
from checks.i2_3.pace import Fault, TimerPace
from checks.i2_3.ticks import HZ, Series
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.wording import shape

BLOCKED_SHARE = 0.75
"""A timer that pauses for less than this share of a call is not blocked by the whole call."""

MIN_REPEATS = 4
"""At least this many lines of the same shape are taken for a timer's."""


def no_answer(seen: SingleCalls) -> Observation:
    """No single call was answered."""
    return Symptom.NO_ANSWER.seen(seen.trace, stuck=seen.stuck, answers=seen.spins, service=SERVICE, type=TYPE)


def wrong_sum(answer: CallAnswer, trace: Trace) -> Observation:
    """A call was answered with another sum."""
    assert answer.response is not None
    return Symptom.WRONG_ANSWER.seen(
        trace,
        service=SERVICE,
        answer=answer,
        wanted=right_sum(answer),
        early=answer.took_s < SHORTEST_S,
        says=f"the sum is {answer.response['sum']} instead of {right_sum(answer)}",
        do="Compare what the callback computes with the fields of the request.",
    )


def wrong_duration(answer: CallAnswer, trace: Trace) -> Observation:
    """A call was answered too early, or too late."""
    early = answer.took_s < SHORTEST_S
    return Symptom.WRONG_ANSWER.seen(trace, service=SERVICE, early=early, took_s=answer.took_s, wanted_s=WORK_S)


def stops(pace: TimerPace) -> bool:
    """Whether the timer stands still for most of a call."""
    return pace.fault is Fault.GAP and not (pace.count > 1 and pace.longest_s < BLOCKED_SHARE * pace.for_s)


def other_pace(idle: IdleRun, likely: Series | None) -> Observation:
    """No 10 Hz timer was seen while nobody called."""
    if likely is None:
        at_end = idle.ending.output if idle.ending else ()
        repeated = Counter(shape(line.text) for line in (*idle.trace.output, *at_end))
        return Symptom.NOT_LOGGED.seen(
            idle.trace,
            what="the timer's message",
            wanted_hz=HZ,
            recognise=lambda text: repeated[shape(text)] >= MIN_REPEATS,
            at_end=at_end,
            says="while nobody calls, no message comes again and again in the log",
            do="Check that the timer is made at start-up, and that its callback logs at INFO with the node's logger.",
        )
    says = f"the messages that are repeated come {likely.hz:.1f} times a second, not {HZ:g} times"
    do = "Look at the period that the timer gets, and at which of its ticks it logs."
    if likely.numbered:
        says = f"the number in the messages that are repeated rises {likely.hz:.1f} times a second, not {HZ:g} times"
        do = "Look at the period that the timer gets, and at the number that it logs."
    elif likely.hz < HZ:
        says += ", and have no number that counts the ticks"
        do = "Look at the period that the timer gets; if it does not log each tick, let it log the tick's number."
    return Symptom.WRONG_RATE.seen(idle.trace, wanted_hz=HZ, found_hz=likely.hz, says=says, do=do)


def disturbed_timer(seen: SingleCalls, pace: TimerPace) -> Observation:
    """The timer does not keep its pace during a call."""
    paces = {Fault.FAST: "fast", Fault.SLOW: "slow", Fault.GAP: "pauses"}
    return Symptom.STANDS_STILL.seen(
        seen.trace,
        stuck=seen.stuck,
        service=SERVICE,
        stops=stops(pace),
        pace="" if pace.fault is None or stops(pace) else paces[pace.fault],
        pause_s=pace.longest_s,
        says="the timer stops while the service works",
        do="Look at the executor and at the callback groups: may the timer and the service run side by side?",
    )


def lost_calls(trace: Trace, batch: CallBatch) -> Observation:
    """Some of three calls at once did not get their own sum."""
    answered = [answer for answer in batch.answers if answer.response is not None]
    lost = len(batch.answers) - len(answered)
    if lost:
        return Symptom.NO_ANSWER.seen(
            trace,
            service=SERVICE,
            says=f"{lost} of {len(batch.answers)} calls made at once got no answer",
            do="Let each call wait its turn, or work beside the others, and return its response.",
        )
    sums = [answer.response["sum"] for answer in answered if answer.response is not None]
    wrong = next(answer for answer in answered if answer.response and answer.response["sum"] != right_sum(answer))
    return Symptom.WRONG_ANSWER.seen(
        trace,
        service=SERVICE,
        answer=wrong,
        wanted=right_sum(wrong),
        early=any(answer.took_s < SHORTEST_S for answer in answered),
        shared=any(sums.count(right_sum(answer)) > 1 for answer in answered),
        says=f"the sums of three calls at once are {', '.join(map(str, sums))}",
        do="Compute each answer from the fields of its own request, and keep nothing from other calls in it.",
    )


def waiting_calls(trace: Trace, ratio: float) -> Observation:
    """Three calls at once took `ratio` times as long as one."""
    return Symptom.CALLS_WAIT.seen(
        trace,
        service=SERVICE,
        ratio=ratio,
        says=f"{'some' if ratio < SEQUENTIAL_RATIO else 'all'} of three calls at once wait for another one to end",
        do="Look at the service's callback group, at the executor's threads, and for a lock in the callback.",
    )
