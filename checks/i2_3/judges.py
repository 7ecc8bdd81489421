"""I2.3: the verdict on each criterion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from checks.i2_3 import symptoms
from checks.i2_3.facts import (
    CALLS,
    EXCUSED_S,
    LONGEST_S,
    PARALLEL_RATIO,
    SERVICE,
    SHORTEST_S,
    TYPE,
    WORK_S,
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
from tutor.judge.symptom import Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Undecided, Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import counted, describe_no_answer, output_tail


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
        return failed(expected, observed, symptoms.no_answer(seen), output_tail(seen.trace))
    for call in seen.calls:
        answer = call.answer
        if answer.response is not None and answer.response["sum"] != right_sum(answer):
            return failed(expected, _describe_answer(answer), symptoms.wrong_sum(answer, seen.trace))
    if best.answer.took_s < SHORTEST_S:
        return _fail_too_quick(best.answer, seen.trace, expected)
    if not best.in_time:
        if best.nearly_in_time and all(call.busy for call in seen.calls):
            return undecided("to time the service")
        return failed(expected, _describe_answer(best.answer), symptoms.wrong_duration(best.answer, seen.trace))
    return passed(expected, _describe_answer(best.answer))


def _fail_too_quick(answer: CallAnswer, trace: Trace, expected: str) -> Verdict:
    return failed(expected, _describe_answer(answer), symptoms.wrong_duration(answer, trace))


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
    return bool(paces) and seen.trace.exit is None and all(map(symptoms.stops, paces))


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
        why = symptoms.no_answer(seen) if silent else symptoms.other_pace(idle, likely)
        return failed(expected, observed, why, evidence)
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
        return failed(expected, observed, symptoms.disturbed_timer(seen, pace), output_tail(seen.trace))
    if pace.fault is None:
        return passed(expected, observed, texts[:6])
    if is_excused(seen.trace.logs, calls[-1], right):
        return undecided("to listen to the timer")
    return failed(expected, observed, symptoms.disturbed_timer(seen, pace), texts[-6:])


def _describe_pace(pace: TimerPace, series: Series) -> str:
    rate = f", {pace.hz:.1f} ticks/s" if pace.hz is not None and pace.fault is not Fault.GAP else ""
    return (
        f"during the call of {pace.for_s:.1f} s: {counted(pace.count, 'message')}{rate}, "
        f"the longest pause {pace.longest_s:.2f} s (outside {series.longest_s:.2f} s)"
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
    if len(answered) < CALLS and batch.cpu_wait_s >= batch.took_s and seen.trace.exit is None:
        return undecided("to answer three calls")
    observed = f"{batch.correct_count} of {CALLS} right, {CALLS - len(answered)} not answered"
    never_answers = single is not None and bool(single.calls) and single.quickest is None and not answered
    is_known = single is not None and never_answers and seen.trace.exit is None
    why = symptoms.no_answer(single) if single and is_known else symptoms.lost_calls(seen.trace, batch)
    return failed(expected, observed, why, answers)


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
    return failed(expected, observed, symptoms.waiting_calls(concurrent.trace, best.took_s / one_s))


def judge_shutdown(seen: IdleRun) -> Verdict:
    return ending.judge_ending(seen.trace, seen.ending, shown_by="blocks")


def judge_shutdown_busy(seen: Interrupted, single_calls: SingleCalls) -> Verdict:
    if not seen.called and seen.ending is not None and has_service(seen.trace.graph.servers) is False:
        return skipped(f"not judged, because there is no {SERVICE} to call: `blocks` did not pass")
    verdict = ending.judge_ending(seen.trace, seen.ending, shown_by="blocks")
    if verdict.passed and single_calls.quickest is None:
        return skipped("not judged, because no call is answered, so none may have been under way: see `blocks`")
    return verdict
