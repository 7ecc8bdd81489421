"""I2.3: the verdict on each criterion, and what it saw go wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from checks.i2_3_multi_threaded_service.call_scenarios import ConcurrentCalls, Interrupted
from checks.i2_3_multi_threaded_service.calls import (
    ALLOWANCE_S,
    CALLS,
    LONGEST_S,
    PARALLEL_RATIO,
    SEQUENTIAL_RATIO,
    SERVER,
    SHORTEST_S,
    SLOW_ADD,
    WORK_S,
    CallBatch,
    all_only_slowed,
    is_right,
    is_wrong,
    right_sum,
    sum_in,
)
from checks.i2_3_multi_threaded_service.idle_run import IdleRun
from checks.i2_3_multi_threaded_service.single_calls import SingleCalls
from checks.i2_3_multi_threaded_service.timer_logs import HZ, Series, best_series
from checks.i2_3_multi_threaded_service.timer_pace import TimerPace, Watch, measure_timer
from tutor.exercise.service_calls import describe_request
from tutor.judge.ending import judge_ending
from tutor.judge.rates import TOLERANCE
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Undecided, Verdict, failed, passed, skipped, undecided
from tutor.judge.wording import describe_no_answer, output_tail, shape

SERVICE, TYPE = SLOW_ADD.name, SLOW_ADD.type

MIN_REPEATS = 4
"""At least this many lines of the same shape are taken for a timer's."""


def judge_blocks(seen: SingleCalls, concurrent: ConcurrentCalls) -> Verdict:
    # If concurrent calls get wrong sums, too, `concurrent` reports that: judge only the first call here.
    if any(batch.correct_count < CALLS for batch in concurrent.batches[:1]):
        return _judge_answer(replace(seen, later=()))
    verdict = _judge_both_calls(seen, _judge_answer)
    # A wait for the next tick of a clock that runs all the time may be long enough for one call by chance.
    quick = [answer for batch in concurrent.batches for answer in batch.answered if answer.took_s < SHORTEST_S]
    return _fail_answer(quick[0], seen.trace, verdict.expected) if verdict.passed and quick else verdict


def judge_blocks_so_far(seen: SingleCalls) -> Verdict | None:
    """Judge `blocks` by the calls so far, if any was answered."""
    return _judge_answer(seen) if seen.quickest is not None else None


def _judge_both_calls(seen: SingleCalls, judge: Callable[[SingleCalls], Verdict]) -> Verdict:
    """The verdict on the first call, unless that passed and the second call fails, or cannot be judged."""
    first, *later = seen.first_and_later
    verdict = judge(first)
    for second_call in later if verdict.passed else ():
        second = judge(second_call)
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
        return failed(expected, observed, no_answer(seen), output_tail(seen.trace))
    wrong = next((call.answer for call in seen.calls if call.answered and not is_right(call.answer)), None)
    if wrong is not None or is_wrong(best.answer):
        return _fail_answer(wrong or best.answer, seen.trace, expected)
    if best.in_time:
        return passed(expected, _describe(best.answer))
    if best.nearly_in_time and all(call.slowed for call in seen.calls):
        return undecided("to time the service")
    return _fail_answer(best.answer, seen.trace, expected)


def no_answer(seen: SingleCalls) -> Observation:
    """No single call was answered."""
    return Symptom.NO_ANSWER.seen(seen.trace, stuck=seen.stuck, answers=seen.spins, service=SERVICE, type=TYPE)


def _fail_answer(answer: CallAnswer, trace: Trace, expected: str) -> Verdict:
    return failed(expected, _describe(answer), wrong_answer(answer, trace))


def wrong_answer(answer: CallAnswer, trace: Trace) -> Observation:
    """A call was answered with another sum, or too early, or too late."""
    if is_right(answer):
        early, took_s = answer.took_s < SHORTEST_S, answer.took_s
        return Symptom.WRONG_ANSWER.seen(trace, service=SERVICE, early=early, took_s=took_s, wanted_s=WORK_S)
    says = f"the sum is {sum_in(answer)} instead of {right_sum(answer)}"
    return _wrong_sums(trace, [answer], says, "Compare what the callback computes with the fields of the request.")


def _wrong_sums(trace: Trace, answers: Sequence[CallAnswer], says: str, do: str) -> Observation:
    """Not all of these calls were answered with their own sum."""
    sums, wrong = [sum_in(answer) for answer in answers], next(answer for answer in answers if not is_right(answer))
    return Symptom.WRONG_ANSWER.seen(
        trace,
        service=SERVICE,
        answer=wrong,
        wanted=right_sum(wrong),
        early=any(answer.took_s < SHORTEST_S for answer in answers),
        shared=any(sums.count(right_sum(answer)) > 1 for answer in answers),
        says=says,
        do=do,
    )


def _describe(answer: CallAnswer) -> str:
    asked = describe_request(SLOW_ADD, answer.request)
    return (
        f"{asked}: no answer" if sum_in(answer) is None else f"{asked} = {sum_in(answer)} after {answer.took_s:.2f} s"
    )


def judge_timer(idle: IdleRun, seen: SingleCalls) -> Verdict:
    return _judge_both_calls(seen, partial(_judge_timer, idle))


def judge_idle_timer(idle: IdleRun) -> Verdict | None:
    """Judge `timer` by the run without calls, if its pace is wrong even then."""
    likely = best_series(idle.series)
    return _judge_timer(idle, SingleCalls(idle.trace)) if likely and not likely.is_10_hz else None


def judge_timer_so_far(seen: SingleCalls) -> Verdict | None:
    """Judge `timer` by the first call and its repetitions, unless the stack dump is still needed for the cause."""
    if seen.idle is None or seen.quickest is None:
        return None
    watch = Watch(seen.trace.logs, seen.idle.series)
    paces = [pace for call in seen.calls for pace in watch.paces(call)]
    # For a blocked timer, `call_singly` is about to take a stack dump.
    is_blocked = bool(paces) and seen.trace.exit is None and all(pace.stops for pace in paces)
    return None if is_blocked else _judge_timer(seen.idle, seen)


def _judge_timer(idle: IdleRun, seen: SingleCalls) -> Verdict:
    expected = (
        f"the timer of {HZ:g} Hz (±{TOLERANCE:.0%}) logs during a call at the pace it has outside one, without a gap "
        "or a burst"
    )
    likely = best_series(idle.series)
    if likely is None or not likely.is_10_hz:
        if idle.pace_slowed:
            return undecided("to measure the timer")
        observed = f"outside a call: {likely}" if likely else "outside a call, the node logs nothing repeatedly"
        evidence = [tick.text for tick in likely.ticks[:4]] if likely else output_tail(idle.trace)
        silent = likely is None and bool(seen.calls) and not seen.spins
        return failed(expected, observed, no_answer(seen) if silent else other_pace(idle, likely), evidence)
    if not seen.calls:
        return skipped("not judged, because there was no call to listen during: `blocks` did not pass")
    watch = Watch(seen.trace.logs, idle.series)
    calls = [call for call in seen.calls if not watch.passes_by_allowance(call)] or seen.calls
    found = [(series, measure_timer(series, watch.logs, call)) for call in calls for series in watch.right]
    series, pace = next(
        ((series, pace) for series, pace in found if not pace.fault),
        next((series, pace) for series, pace in reversed(found) if series == likely),
    )
    texts = [log.text for log in watch.logs if series.key.of(log)]
    observed = f"outside: {series}; {pace.beside(series)}"
    if seen.trace.exit is not None:
        observed = f"{observed}; then the process ended by itself with {seen.trace.exit}"
        return failed(expected, observed, disturbed_timer(seen, pace), output_tail(seen.trace))
    if pace.fault is None:
        return passed(expected, observed, texts[:6])
    if watch.is_slowed(calls[-1]):
        return undecided("to listen to the timer")
    return failed(expected, observed, disturbed_timer(seen, pace), texts[-6:])


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
    return Symptom.STANDS_STILL.seen(
        seen.trace,
        stuck=seen.stuck,
        service=SERVICE,
        stops=pace.stops,
        pace="" if pace.fault is None or pace.stops else pace.fault.value,
        pause_s=pace.longest_s,
        says="the timer stops while the service works",
        do="Look at the executor and at the callback groups: may the timer and the service run side by side?",
    )


def judge_concurrent(seen: ConcurrentCalls, single: SingleCalls | None = None) -> Verdict:
    expected = "three calls made at once are all answered, each with its own sum"
    if not seen.batches:
        return skipped(f"not judged, because there is no {SERVICE}: `blocks` did not pass")
    batch = seen.batches[0]
    answers = [_describe(answer) for answer in sorted(batch.answers, key=lambda answer: answer.answered_at)]
    if batch.correct_count == CALLS:
        return passed(expected, f"all {CALLS} within {batch.took_s:.2f} s", answers)
    lost, running = CALLS - len(batch.answered), seen.trace.exit is None
    if lost and running and batch.cpu_wait_s >= batch.took_s:
        return undecided("to answer three calls")
    observed = f"{batch.correct_count} of {CALLS} right, {lost} not answered"
    if single is not None and single.calls and single.quickest is None and lost == CALLS and running:
        return failed(expected, observed, no_answer(single), answers)
    return failed(expected, observed, lost_calls(seen.trace, batch), answers)


def judge_concurrent_so_far(seen: ConcurrentCalls) -> Verdict | None:
    """Judge `concurrent` by itself, unless no call was answered: then the single calls explain the cause better."""
    return judge_concurrent(seen) if any(batch.answered for batch in seen.batches[:1]) else None


def lost_calls(trace: Trace, batch: CallBatch) -> Observation:
    """Some of three calls at once did not get their own sum."""
    if lost := len(batch.answers) - len(batch.answered):
        return Symptom.NO_ANSWER.seen(
            trace,
            service=SERVICE,
            says=f"{lost} of {len(batch.answers)} calls made at once got no answer",
            do="Let each call wait its turn, or work beside the others, and return its response.",
        )
    says = f"the sums of three calls at once are {', '.join(str(sum_in(answer)) for answer in batch.answered)}"
    do = "Compute each answer from the fields of its own request, and keep nothing from other calls in it."
    return _wrong_sums(trace, batch.answered, says, do)


def judge_parallel(single: SingleCalls, concurrent: ConcurrentCalls) -> Verdict:
    expected = f"three calls at once take less than {PARALLEL_RATIO:g} times one call"
    assert single.quickest is not None  # it was answered: `blocks` passed
    one_s = single.quickest.answer.took_s
    best = min(concurrent.batches, key=lambda batch: batch.took_s)
    observed = f"one call {one_s:.2f} s, three at once {best.took_s:.2f} s ({best.took_s / one_s:.1f} times)"
    if any(batch.took_s < PARALLEL_RATIO * one_s + min(batch.cpu_wait_s, ALLOWANCE_S) for batch in concurrent.batches):
        return passed(expected, observed)
    if all_only_slowed(concurrent.batches, one_s):
        return undecided("to time three calls at once")
    return failed(expected, observed, waiting_calls(concurrent.trace, best.took_s / one_s))


def waiting_calls(trace: Trace, ratio: float) -> Observation:
    """Three calls at once took `ratio` times as long as one."""
    return Symptom.CALLS_WAIT.seen(
        trace,
        service=SERVICE,
        ratio=ratio,
        says=f"{'some' if ratio < SEQUENTIAL_RATIO else 'all'} of three calls at once wait for another one to end",
        do="Look at the service's callback group, at the executor's threads, and for a lock in the callback.",
    )


def judge_shutdown_busy(seen: Interrupted, single: SingleCalls) -> Verdict:
    if not seen.called and seen.ending is not None and SERVER.missing(seen.trace.graph.servers):
        return skipped(f"not judged, because there is no {SERVICE} to call: `blocks` did not pass")
    verdict = judge_ending(seen.trace, seen.ending, shown_by="blocks")
    if verdict.passed and single.quickest is None:
        return skipped("not judged, because no call is answered, so none may have been under way: see `blocks`")
    return verdict
