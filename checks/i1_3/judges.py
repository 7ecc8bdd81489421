"""I1.3: the verdicts on the server, as pure functions of the facts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from checks.i1_3.facts import (
    ENDED_BY_A_CALL,
    OPERATOR_SIGNS,
    TYPE,
    ServiceCalls,
    correct_result,
    missing_services,
)
from tutor.judge import ending
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Status, Verdict, failed, passed, skipped
from tutor.judge.wording import describe_no_answer, output_tail


def judge_services(seen: ServiceCalls) -> Verdict:
    expected = f"/add, /subtract, /multiply and /divide with type {TYPE}, answering a call"
    unanswered = next((answer for answer in seen.answers if answer.response is None), None)
    missing = missing_services(seen.trace.graph.servers) or ([] if unanswered else _never_called(seen))
    if missing:
        observed = f"missing: {', '.join(missing)}"
        return failed(expected, observed, _missing(seen.trace, missing), output_tail(seen.trace))
    if seen.ended_by_a_call:
        return skipped(ENDED_BY_A_CALL)
    if unanswered is not None:
        observed = f"{unanswered.service}: {describe_no_answer(seen.trace, unanswered.took_s)}"
        silent = Symptom.NO_ANSWER.seen(
            seen.trace,
            stuck=seen.stuck,
            answers=seen.spins,
            service=unanswered.service,
            type=TYPE,
            says=f"{unanswered.service} is there, and does not answer a call",
            do=f"Follow the callback of {unanswered.service} to where it stays, and let it return its response.",
        )
        return failed(expected, observed, silent, output_tail(seen.trace))
    return passed(
        expected, "all four answer", [f"{name} = {result}" for name, result in _operands_and_results(seen.answers)]
    )


def _never_called(seen: ServiceCalls) -> list[str]:
    """The services that were not up yet when it was their turn, though they may be in the graph by now."""
    return [name for name in OPERATOR_SIGNS if not seen.of(name)]


def _missing(trace: Trace, missing: Sequence[str]) -> Observation:
    return Symptom.SERVICE_MISSING.seen(
        trace,
        service=missing[0],
        type=TYPE,
        services=tuple(OPERATOR_SIGNS),
        says=f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} not there",
        do="Create each service where the node is set up, under its own name and with its own callback.",
    )


def judge_operations(seen: ServiceCalls, simple: ServiceCalls) -> Verdict:
    """Judge `operations`. `simple`: the calls by which `services` is judged."""
    if judge_services(simple).status is Status.FAILED:
        return skipped("not judged, because `services` did not pass")
    for answer in seen.answers:
        a, b = answer.request["a"], answer.request["b"]
        right = correct_result(answer.service, a, b)
        asked = f"{answer.service}: {a} {OPERATOR_SIGNS[answer.service]} {b} = {right}"
        if answer.response is None:
            observed = describe_no_answer(seen.trace, answer.took_s)
            return failed(asked, observed, _no_answer(seen.trace, answer), output_tail(seen.trace))
        if answer.response["sum"] != right:
            evidence = [f"{name} answered {result}" for name, result in _operands_and_results(seen.of(answer.service))]
            return failed(asked, f"{answer.response['sum']}", _wrong_result(seen, answer, right), evidence)
    expected = "right results, negative operands included"
    if late := _never_called(seen):
        return failed(expected, f"missing: {', '.join(late)}", _missing(seen.trace, late))
    return passed(
        expected,
        f"{len(seen.answers)} calls",
        [f"{name} = {result}" for name, result in _operands_and_results(seen.answers)][:8],
    )


def _no_answer(trace: Trace, answer: CallAnswer) -> Observation:
    return Symptom.NO_ANSWER.seen(
        trace,
        service=answer.service,
        type=TYPE,
        says=f"{answer.service} answers other calls, but not this one",
        do=f"Let the callback of {answer.service} return its response, whatever the operands are.",
    )


def _wrong_result(seen: ServiceCalls, answer: CallAnswer, right: int) -> Observation:
    assert answer.response is not None
    got, a, b = answer.response["sum"], answer.request["a"], answer.request["b"]
    return Symptom.WRONG_ANSWER.seen(
        seen.trace,
        service=answer.service,
        type=TYPE,
        answer=answer,
        wanted=right,
        calls=seen.answers,
        says=f"to {a} and {b}, {answer.service} answers {got} instead of {right}",
        do=f"Follow {a} and {b} through the callback of {answer.service} to where they become {got}.",
    )


def _operands_and_results(answers: Sequence[CallAnswer]) -> list[tuple[str, Any]]:
    return [
        (f"{a.request['a']} {OPERATOR_SIGNS[a.service]} {a.request['b']}", a.response["sum"])
        for a in answers
        if a.response is not None
    ]


def judge_shutdown(seen: ServiceCalls) -> Verdict:
    shown_by = "services" if judge_services(seen).status is Status.FAILED else "operations"
    return ending.judge_ending(seen.trace, seen.ending, shown_by=shown_by)
