"""I1.3: the verdict on a division by zero."""

from __future__ import annotations

from checks.i1_3.facts import (
    ENDED_BY_A_CALL,
    SAYS_ERROR,
    TYPE,
    Division,
    correct_result,
    find_complaints,
)
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Verdict, failed, passed, skipped
from tutor.judge.wording import describe_no_answer, output_tail


def judge_division(seen: Division) -> Verdict:
    """Judge `divide-by-zero`."""
    expected = "a division by zero gets an answer, the node reports it as an error, and the next calls succeed"
    if seen.by_zero is None and seen.before is not None and seen.trace.exit is not None:
        return skipped(ENDED_BY_A_CALL)
    tail = output_tail(seen.trace)
    if seen.before is None or seen.by_zero is None:
        why = _no_answer(seen.trace, "/divide does not answer", "Let the callback of /divide return its response.")
        return failed(expected, "/divide does not answer even 84 ÷ 7", why, tail)
    if seen.by_zero.response is None:
        why = _no_answer(
            seen.trace, "/divide does not answer when b is 0", "Return the response in that case too, and go on."
        )
        return failed(expected, f"10 ÷ 0: {describe_no_answer(seen.trace, seen.by_zero.took_s)}", why, tail)
    complaints = find_complaints(seen.ordinary, seen.logged)
    divides = _result(seen.before) == correct_result("/divide", **seen.before.request)
    # The last log messages of a node that exits may never reach us: in that case, report the exit instead.
    has_exited = seen.trace.exit is not None and any(answer.response is None for answer in seen.after)
    if not complaints and not has_exited:
        observed = f"answered {seen.by_zero.response['sum']}, without a word about an error"
        return failed(expected, observed, _silent(seen, divides), [str(log) for log in seen.logged])
    for answer in seen.after:
        a, b = answer.request["a"], answer.request["b"]
        if answer.response is None:
            says, do = "the node no longer answers after a division by zero", "Only log and answer there, and go on."
            return failed(expected, f"after it, {a} ÷ {b} got no answer", _no_answer(seen.trace, says, do), tail)
        if b and divides and answer.response["sum"] != correct_result("/divide", a, b):
            observed = f"after it, {a} ÷ {b} was answered {answer.response['sum']}"
            return failed(expected, observed, _wrong_since(seen, answer))
    return passed(
        expected,
        f"answered {seen.by_zero.response['sum']}, and {len(seen.after)} calls after it",
        [str(complaints[0])],
    )


def _result(answer: CallAnswer) -> object:
    return answer.response["sum"] if answer.response is not None else None


def _no_answer(trace: Trace, says: str, do: str) -> Observation:
    return Symptom.NO_ANSWER.seen(trace, service="/divide", type=TYPE, says=says, do=do)


def _silent(seen: Division, divides: bool) -> Observation:
    """Nothing that the node logs reports an error."""
    assert seen.before is not None
    says, do = "nothing that the node logs reports an error", "Log an error where b is 0, before you answer."
    if not divides:
        says = f"no error is reported, since /divide does not divide: 84 ÷ 7 is answered {_result(seen.before)}"
        do = "Let /divide divide first, then look at what it does when b is 0."
    return Symptom.NOT_LOGGED.seen(
        seen.trace,
        what="the error",
        recognise=SAYS_ERROR.search,
        at_end=seen.at_end,
        ordinary=seen.ordinary,
        logged=seen.logged,
        says=says,
        do=do,
    )


def _wrong_since(seen: Division, answer: CallAnswer) -> Observation:
    assert seen.before is not None
    a, b = answer.request["a"], answer.request["b"]
    return Symptom.WRONG_ANSWER.seen(
        seen.trace,
        service="/divide",
        type=TYPE,
        answer=answer,
        wanted=correct_result("/divide", a, b),
        calls=(seen.before, *seen.after),
        says="the node divides correctly until it is asked to divide by zero",
        do="Let a division by zero change nothing in the node: only log and answer.",
    )
