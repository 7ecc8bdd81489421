"""I2.3: the verdict on each criterion."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from checks.i2_3.facts import (
    CALLS,
    EXCUSED_S,
    LONGEST_S,
    PARALLEL_RATIO,
    SERVICE,
    SHORTEST_S,
    TYPE,
    WORK_S,
    CallBatch,
    ConcurrentCalls,
    IdleRun,
    Interrupted,
    SingleCalls,
    has_service,
    is_doubtful,
    is_excused,
    right_sum,
    timer_during_call,
)
from checks.i2_3.pace import Fault, TimerPace
from checks.i2_3.ticks import HZ, Series, best_series
from tutor.judge import ending
from tutor.judge.rates import TOLERANCE
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Undecided, Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import counted, describe_no_answer, output_tail, shape

BLOCKED_SHARE = 0.75
"""A timer that pauses for less than this share of a call is not blocked by the whole call."""

MIN_REPEATS = 4
"""At least this many lines of the same shape are taken for a timer's."""


def judge_blocks(seen: SingleCalls, concurrent: ConcurrentCalls) -> Verdict:
    # If concurrent calls get wrong sums, too, `concurrent` reports that: judge only the first call here.
    concurrent_wrong = any(batch.correct_count < CALLS for batch in concurrent.batches[:1])
    verdict = _judge_answer(replace(seen, later=())) if concurrent_wrong else _judge_both_calls(seen, _judge_answer)
    if verdict.passed and not concurrent_wrong:
        # A wait for the next tick of a clock that runs all the time may be long enough for one call by chance.
        answered = (each for batch in concurrent.batches for each in batch.answers if each.response is not None)
        quick = next((each for each in answered if each.took_s < SHORTEST_S), None)
        verdict = _fail_too_quick(quick, seen.trace, verdict.expected) if quick is not None else verdict
    return verdict


def judge_blocks_so_far(seen: SingleCalls) -> Verdict | None:
    """Judge `blocks` by the calls so far, if any was answered."""
    return _judge_answer(seen) if seen.quickest is not None else None


def _judge_both_calls(seen: SingleCalls, judge: Callable[[SingleCalls], Verdict]) -> Verdict:
    """The verdict on the first call, unless that passed and the second call fails, or cannot be judged."""
    first, *later = seen.first_and_later
    verdict = judge(first)
    for each in later if verdict.passed else ():
        second = judge(each)
        if isinstance(second, Undecided):
            return second
        if not second.passed:
            return replace(second, observed=f"the second call: {second.observed}")
    return verdict


def _judge_answer(seen: SingleCalls) -> Verdict:
    expected = f"{SERVICE} ({TYPE}) answers with the sum after {WORK_S:g} s ({SHORTEST_S:g} to {LONGEST_S:g} s)"
    if not seen.calls:
        missing = Symptom.SERVICE_MISSING.seen(seen.trace, service=SERVICE, type=TYPE)
        return failed(expected, f"there is no {SERVICE} of this type", missing, output_tail(seen.trace))
    best = seen.quickest
    if best is None:
        observed = describe_no_answer(seen.trace, max(call.answer.took_s for call in seen.calls))
        return failed(expected, observed, _no_answer(seen), output_tail(seen.trace))
    for call in seen.calls:
        answer = call.answer
        if answer.response is not None and answer.response["sum"] != right_sum(answer):
            return failed(expected, _describe_answer(answer), _wrong_sum(answer, seen.trace))
    if best.answer.took_s < SHORTEST_S:
        return _fail_too_quick(best.answer, seen.trace, expected)
    if not best.in_time:
        if best.nearly_in_time and all(call.busy for call in seen.calls):
            return undecided("to time the service")
        return failed(expected, _describe_answer(best.answer), _wrong_time(best.answer, seen.trace))
    return passed(expected, _describe_answer(best.answer))


def _no_answer(seen: SingleCalls) -> Observation:
    return Symptom.NO_ANSWER.seen(seen.trace, stuck=seen.stuck, answers=seen.spins, service=SERVICE, type=TYPE)


def _wrong_sum(answer: CallAnswer, trace: Trace) -> Observation:
    assert answer.response is not None
    return Symptom.WRONG_ANSWER.seen(
        trace,
        service=SERVICE,
        answer=answer,
        wanted=right_sum(answer),
        early=answer.took_s < SHORTEST_S,
        says=f"the sum is {answer.response['sum']} instead of {right_sum(answer)}",
        do="Look at what the callback adds, and where it puts the result.",
    )


def _wrong_time(answer: CallAnswer, trace: Trace) -> Observation:
    early = answer.took_s < SHORTEST_S
    return Symptom.WRONG_ANSWER.seen(trace, service=SERVICE, early=early, took_s=answer.took_s, wanted_s=WORK_S)


def _fail_too_quick(answer: CallAnswer, trace: Trace, expected: str) -> Verdict:
    return failed(expected, _describe_answer(answer), _wrong_time(answer, trace))


def _describe_answer(answer: CallAnswer) -> str:
    if answer.response is None:
        return f"{answer.request['a']} + {answer.request['b']}: no answer"
    sum_ = answer.response["sum"]
    return f"{answer.request['a']} + {answer.request['b']} = {sum_} after {answer.took_s:.2f} s"


def judge_timer(idle: IdleRun, seen: SingleCalls) -> Verdict:
    return _judge_both_calls(seen, partial(_judge_timer, idle))


def judge_idle_timer(idle: IdleRun) -> Verdict | None:
    """Judge `timer` by the run without calls, if its pace is wrong even then."""
    likely = best_series(idle.series)
    if likely is None or likely.is_10_hz:
        return None
    return _judge_timer(idle, SingleCalls(idle.trace))


def judge_timer_so_far(seen: SingleCalls) -> Verdict | None:
    """Judge `timer` by the first call and its repetitions, unless the stack dump is still needed for the cause."""
    if seen.idle is None or seen.quickest is None:
        return None
    # For a blocked timer, `call_singly` is about to take a stack dump.
    return None if _is_blocked(seen.idle, seen) else _judge_timer(seen.idle, seen)


def _is_blocked(idle: IdleRun, seen: SingleCalls) -> bool:
    """Whether the timer stops for most of a call, so that a stack dump will show why."""
    right = [series for series in idle.series if series.is_10_hz]
    paces = [timer_during_call(series, seen.trace.logs, call) for call in seen.calls for series in right]
    return bool(paces) and seen.trace.exit is None and all(map(_stops, paces))


def _stops(pace: TimerPace) -> bool:
    return pace.fault is Fault.GAP and not (pace.count > 1 and pace.longest_s < BLOCKED_SHARE * pace.for_s)


def _judge_timer(idle: IdleRun, seen: SingleCalls) -> Verdict:
    expected = (
        f"the timer of {HZ:g} Hz (±{TOLERANCE:.0%}) logs during a call at the pace it has outside one, without a gap "
        "or a burst"
    )
    likely = best_series(idle.series)
    if likely is None or not likely.is_10_hz:
        if idle.excused:
            return undecided("to measure the timer")
        observed = f"outside a call: {likely}" if likely else "outside a call, the node logs nothing repeatedly"
        evidence = [tick.text for tick in likely.ticks[:4]] if likely else output_tail(idle.trace)
        silent = likely is None and bool(seen.calls) and not seen.spins
        return failed(expected, observed, _no_answer(seen) if silent else _other_pace(idle, likely), evidence)
    if not seen.calls:
        return skipped("not judged, because there was no call to listen during: `blocks` did not pass")
    right = [series for series in idle.series if series.is_10_hz]
    calls = [call for call in seen.calls if not is_doubtful(seen.trace.logs, call, right)] or seen.calls
    found = [(series, timer_during_call(series, seen.trace.logs, call)) for call in calls for series in right]
    series, pace = next(
        ((series, pace) for series, pace in found if not pace.fault),
        next(each for each in reversed(found) if each[0] == likely),
    )
    texts = [log.text for log in seen.trace.logs if series.key.of(log)]
    observed = f"outside: {series}; {_describe_pace(pace, series)}"
    if seen.trace.exit is not None:
        observed = f"{observed}; then the process ended by itself with {seen.trace.exit}"
        return failed(expected, observed, _disturbed(seen, pace), output_tail(seen.trace))
    if pace.fault is None:
        return passed(expected, observed, texts[:6])
    if is_excused(seen.trace.logs, calls[-1], right):
        return undecided("to listen to the timer")
    return failed(expected, observed, _disturbed(seen, pace), texts[-6:])


def _describe_pace(pace: TimerPace, series: Series) -> str:
    rate = f", {pace.hz:.1f} ticks/s" if pace.hz is not None and pace.fault is not Fault.GAP else ""
    return (
        f"during the call of {pace.for_s:.1f} s: {counted(pace.count, 'message')}{rate}, "
        f"the longest pause {pace.longest_s:.2f} s (outside {series.longest_s:.2f} s)"
    )


def _other_pace(idle: IdleRun, likely: Series | None) -> Observation:
    """No 10 Hz timer was seen while nobody called."""
    if likely is None:
        at_end = idle.ending.output if idle.ending else ()
        repeated = Counter(shape(line.text) for line in (*idle.trace.output, *at_end))
        return Symptom.NOT_LOGGED.seen(
            idle.trace,
            what="the timer's message",
            recognise=lambda text: repeated[shape(text)] >= MIN_REPEATS,
            at_end=at_end,
            says="no log message comes again and again while nobody calls",
            do="Let a timer of 10 Hz log at INFO, every tenth tick with its number at least.",
        )
    unnumbered = "" if likely.numbered or likely.hz > HZ else ", and no number in them counts the ticks"
    return Symptom.WRONG_RATE.seen(
        idle.trace,
        wanted_hz=HZ,
        found_hz=likely.hz,
        says=f"the timer's messages come {likely.hz:.1f} times a second, not {HZ:g} times{unnumbered}",
        do="Look at the period that the timer gets, and at which ticks it logs.",
    )


def _disturbed(seen: SingleCalls, pace: TimerPace) -> Observation:
    """The timer does not keep its pace during a call."""
    paces = {Fault.FAST: "fast", Fault.SLOW: "slow", Fault.GAP: "pauses"}
    return Symptom.STANDS_STILL.seen(
        seen.trace,
        stuck=seen.stuck,
        service=SERVICE,
        stops=_stops(pace),
        pace="" if pace.fault is None or _stops(pace) else paces[pace.fault],
        pause_s=pace.longest_s,
    )


def judge_concurrent(seen: ConcurrentCalls, single: SingleCalls | None = None) -> Verdict:
    expected = "three calls made at once are all answered, each with its own sum"
    if not seen.batches:
        return skipped(f"not judged, because there is no {SERVICE}: `blocks` did not pass")
    batch = seen.batches[0]
    answers = [_describe_answer(answer) for answer in sorted(batch.answers, key=lambda answer: answer.answered_at)]
    if batch.correct_count == CALLS:
        return passed(expected, f"all {CALLS} within {batch.took_s:.2f} s", answers)
    answered = [answer for answer in batch.answers if answer.response is not None]
    observed = f"{batch.correct_count} of {CALLS} right, {CALLS - len(answered)} not answered"
    never_answers = single is not None and bool(single.calls) and single.quickest is None and not answered
    why = _no_answer(single) if single and never_answers and seen.trace.exit is None else _lost_calls(seen.trace, batch)
    return failed(expected, observed, why, answers)


def _lost_calls(trace: Trace, batch: CallBatch) -> Observation:
    """Some of three calls at once did not get their own sum."""
    answered = [answer for answer in batch.answers if answer.response is not None]
    lost = len(batch.answers) - len(answered)
    if lost:
        return Symptom.NO_ANSWER.seen(
            trace,
            service=SERVICE,
            says=f"{lost} of {len(batch.answers)} calls made at once got no answer",
            do="Let every call wait its turn or work beside the others, and return its response; refuse none.",
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
        do="Answer every call with its own a and b, also while another one is being worked on.",
    )


def judge_concurrent_so_far(seen: ConcurrentCalls) -> Verdict | None:
    """Judge `concurrent` by itself, unless no call was answered: then the single calls explain the cause better."""
    answered = any(answer.response is not None for batch in seen.batches[:1] for answer in batch.answers)
    return judge_concurrent(seen) if answered else None


def judge_parallel(single: SingleCalls, concurrent: ConcurrentCalls) -> Verdict:
    expected = f"three calls at once take less than {PARALLEL_RATIO:g} times one call"
    quickest = single.quickest
    assert quickest is not None  # it was answered: `blocks` passed
    one_s = quickest.answer.took_s
    best = min(concurrent.batches, key=lambda batch: batch.took_s)
    observed = f"one call {one_s:.2f} s, three at once {best.took_s:.2f} s ({best.took_s / one_s:.1f} times)"
    if any(batch.took_s < PARALLEL_RATIO * one_s + min(batch.cpu_wait_s, EXCUSED_S) for batch in concurrent.batches):
        return passed(expected, observed)
    if not concurrent.is_conclusive(one_s):
        return undecided("to time three calls at once")
    waiting = Symptom.STANDS_STILL.seen(concurrent.trace, service=SERVICE, ratio=best.took_s / one_s)
    return failed(expected, observed, waiting)


def judge_shutdown(seen: IdleRun) -> Verdict:
    return ending.judge_ending(seen.trace, seen.ending, shown_by="blocks")


def judge_shutdown_busy(seen: Interrupted, single_calls: SingleCalls) -> Verdict:
    if not seen.called and seen.ending is not None and has_service(seen.trace.graph.servers) is False:
        return skipped(f"not judged, because there is no {SERVICE} to call: `blocks` did not pass")
    verdict = ending.judge_ending(seen.trace, seen.ending, shown_by="blocks")
    if verdict.passed and single_calls.quickest is None:
        return skipped("not judged, because no call is answered, so none may have been under way: see `blocks`")
    return verdict
