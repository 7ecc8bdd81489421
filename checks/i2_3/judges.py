"""I2.3: what must have been seen."""

from __future__ import annotations

from checks.i2_3 import causes as why
from checks.i2_3.facts import (
    ANSWER_S,
    CALLS,
    LONGEST_S,
    PARALLEL,
    SERVICE,
    SHORTEST_S,
    TYPE,
    WORK_S,
    Interrupted,
    Lone,
    Quiet,
    Trio,
    is_there,
    right_sum,
)
from checks.i2_3.ticks import HZ, During, Fault, Series, best, during
from tutor.judge import causes, ending
from tutor.judge.bench import MachineTooBusy
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import CallAnswer
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped


def judge_blocks(seen: Lone) -> Verdict:
    expected = f"{SERVICE} ({TYPE}) answers with the sum after {WORK_S:g} s ({SHORTEST_S:g} to {LONGEST_S:g} s)"
    answer = seen.answer
    if answer is None:
        return failed(
            expected,
            f"there is no {SERVICE} of this type",
            why.of_no_service(seen.trace),
            causes.last_words(seen.trace),
        )
    if answer.response is None:
        return failed(expected, f"no answer in {ANSWER_S:g} s", why.of_no_answer(seen), causes.last_words(seen.trace))
    told = _told(answer)
    if answer.response["sum"] != right_sum(answer):
        return failed(expected, told, why.of_wrong_sum(answer))
    if answer.took_s < SHORTEST_S:
        cause = Cause(
            "too quick", f"the work takes {answer.took_s:.1f} s", "let the callback wait: time.sleep(3.0), then answer"
        )
        return failed(expected, told, cause)
    if answer.took_s > LONGEST_S + seen.starved_s:
        if seen.excused:
            raise MachineTooBusy("this machine is too busy to time the service")
        cause = Cause(
            "too slow", f"the work takes {answer.took_s:.1f} s", "let the callback wait 3 s once, then answer"
        )
        return failed(expected, told, cause)
    return passed(expected, told)


def _told(answer: CallAnswer) -> str:
    if answer.response is None:
        return f"{answer.request['a']} + {answer.request['b']}: no answer"
    sum_ = answer.response["sum"]
    return f"{answer.request['a']} + {answer.request['b']} = {sum_} after {answer.took_s:.2f} s"


def judge_timer(alone: Quiet, seen: Lone) -> Verdict:
    expected = (
        f"the timer of {HZ:g} Hz (±{TOLERANCE:.0%}) logs during a call at the pace it has outside one, without a gap "
        "or a burst"
    )
    likely = best(alone.series)
    if likely is None or not likely.is_10_hz:
        if alone.excused:
            raise MachineTooBusy("this machine is too busy to measure the timer")
        observed = f"outside a call: {likely}" if likely else "outside a call, the node logs nothing again and again"
        evidence = [tick.text for tick in likely.ticks[:4]] if likely else causes.last_words(alone.trace)
        return failed(expected, observed, why.of_other_pace(alone, likely), evidence)
    if seen.answer is None:
        return skipped("not judged, because there was no call to listen during: `blocks` did not pass")
    found = [(series, _during(series, seen, seen.answer)) for series in alone.series if series.is_10_hz]
    series, call = next(
        ((series, call) for series, call in found if not call.fault), next(each for each in found if each[0] == likely)
    )
    texts = [log.text for log in seen.trace.logs if series.key.of(log)]
    observed = f"outside: {series}; {_heard(call, series)}"
    if call.fault is None:
        return passed(expected, observed, texts[:6])
    if seen.excused:
        raise MachineTooBusy("this machine is too busy to listen to the timer")
    return failed(expected, observed, why.of_disturbed_timer(seen, call.fault), texts[-6:])


def _during(series: Series, seen: Lone, answer: CallAnswer) -> During:
    return during(
        series,
        seen.trace.logs,
        answer.asked_at,
        answer.answered_at,
        until=seen.until,
        starved_s=seen.starved_s,
    )


def _heard(call: During, series: Series) -> str:
    pace = f", {call.hz:.1f} ticks/s" if call.hz is not None and call.fault is not Fault.GAP else ""
    return (
        f"during the call of {call.for_s:.1f} s: {call.count} messages{pace}, the longest pause {call.longest_s:.2f} s "
        f"(outside {series.longest_s:.2f} s)"
    )


def judge_concurrent(seen: Trio) -> Verdict:
    expected = "three calls made at once are all answered, each with its own sum"
    if not seen.answers:
        return skipped(f"not judged, because there is no {SERVICE}: `blocks` did not pass")
    told = [_told(answer) for answer in sorted(seen.answers, key=lambda answer: answer.answered_at)]
    answered = [answer for answer in seen.answers if answer.response is not None]
    right = [answer for answer in answered if answer.response and answer.response["sum"] == right_sum(answer)]
    if len(right) == CALLS:
        return passed(expected, f"all {CALLS} within {_longest(seen):.2f} s", told)
    observed = f"{len(right)} of {CALLS} right, {CALLS - len(answered)} not answered"
    return failed(expected, observed, why.of_lost_calls(seen, answered), told)


def _longest(seen: Trio) -> float:
    return max(a.answered_at for a in seen.answers) - min(a.asked_at for a in seen.answers)


def judge_parallel(one: Lone, three: Trio) -> Verdict:
    expected = f"three calls at once take less than {PARALLEL:g} times one call"
    assert one.answer is not None  # it was answered: `blocks` passed
    took, limit = _longest(three), PARALLEL * one.answer.took_s
    observed = f"one call {one.answer.took_s:.2f} s, three at once {took:.2f} s ({took / one.answer.took_s:.1f} times)"
    if took < limit + three.starved_s:
        return passed(expected, observed)
    cause = Cause(
        "one call at a time",
        "the calls wait for each other",
        "put the service into a ReentrantCallbackGroup, and give the executor threads enough: num_threads=8",
    )
    return failed(expected, observed, cause)


def judge_shutdown(seen: Quiet) -> Verdict:
    return ending.judge(seen.trace, seen.ending)


def judge_shutdown_busy(seen: Interrupted) -> Verdict:
    if not seen.called and seen.ending is not None and is_there(seen.trace.graph.services) is False:
        return skipped(f"not judged, because there is no {SERVICE} to call: `blocks` did not pass")
    return ending.judge(seen.trace, seen.ending)
