"""I1.3: the verdicts on the server, as pure functions of the facts."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from checks.i1_3 import late_binding, service_steps, services, steps
from checks.i1_3.code import Code, learner_files, with_applicable_step
from checks.i1_3.facts import (
    ENDED_BY_A_CALL,
    OPERATOR_SIGNS,
    TYPE,
    ServiceCalls,
    correct_result,
    missing_services,
)
from checks.i1_3.rewriting import with_applicable_steps
from tutor.judge import causes, ending, tracebacks
from tutor.judge.causes import names, spinning
from tutor.judge.causes.unawaited import diagnose_unawaited, unawaited_names
from tutor.judge.causes.uncalled import diagnose_awaited_service, diagnose_uncalled_setup
from tutor.judge.rewriting.callbacks import only_waits, outermost
from tutor.judge.rewriting.node import find_in_files, node_file, started_node
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause, Status, Verdict, failed, passed, skipped


@with_applicable_steps
def judge_services(seen: ServiceCalls) -> Verdict:
    expected = f"/add, /subtract, /multiply and /divide with type {TYPE}, answering a call"
    unanswered = next((answer for answer in seen.answers if answer.response is None), None)
    missing = missing_services(seen.trace.graph.servers) or ([] if unanswered else _never_called(seen))
    if missing:
        cause = _diagnose_missing(seen.trace, missing)
        return failed(expected, f"missing: {', '.join(missing)}", cause, causes.output_tail(seen.trace))
    if seen.ended_by_a_call:
        return skipped(ENDED_BY_A_CALL)
    if unanswered is not None:
        observed = f"{unanswered.service}: {causes.describe_no_answer(seen.trace, unanswered.took_s)}"
        silent = [service for service in seen.trace.graph.servers if service.name == unanswered.service]
        cause = causes.diagnose_incompatible_service(silent) or causes.diagnose_no_answer(
            seen.trace, seen.stuck, spins=seen.spins
        )
        cause = with_answer_step(cause, seen.trace, unanswered.service, seen.stuck)
        return failed(expected, observed, cause, causes.output_tail(seen.trace))
    return passed(
        expected, "all four answer", [f"{name} = {result}" for name, result in _operands_and_results(seen.answers)]
    )


def _never_called(seen: ServiceCalls) -> list[str]:
    """The services that were not up yet when it was their turn, though they may be in the graph by now."""
    return [name for name in OPERATOR_SIGNS if not seen.of(name)]


def _diagnose_missing(trace: Trace, missing: Sequence[str]) -> Cause:
    broken = causes.diagnose_process(trace)
    if broken is not None:
        asks = broken.name == names.UNHANDLED_EXCEPTION and "EOFError" in broken.text
        return with_applicable_step(broken, trace, lambda: _first_step(trace, steps.remove_input) if asks else None)
    if (early := find_in_files(trace, spinning.diagnose_spin_in_constructor)) is not None:
        return with_applicable_step(early, trace)
    offered = [s for s in trace.graph.servers if not s.is_standard]
    mistyped = [service for service in offered if service.name in missing and service.type != TYPE]
    if mistyped:
        cause = Cause(
            "wrong type",
            f"{mistyped[0].name} has the type {mistyped[0].type}, not {TYPE}",
            f"create it with AddTwoInts: self.create_service(AddTwoInts, '{mistyped[0].name[1:]}', ...)",
        )
        return with_applicable_step(cause, trace, lambda: service_steps.set_types(trace, [s.name for s in mistyped]))
    misnamed = [
        (s.name, name)
        for name in missing
        for s in offered
        if s.name not in OPERATOR_SIGNS and _is_similar(s.name, name)
    ]
    if misnamed:
        cause = Cause(
            "wrong service name",
            f"there is {misnamed[0][0]} instead of {misnamed[0][1]}",
            f"name it {misnamed[0][1][1:]!r}, without a namespace or ~ in front",
        )
        return with_applicable_step(cause, trace, lambda: service_steps.rename_services(trace, misnamed))
    if (destroyed := service_steps.diagnose_destroyed(trace)) is not None:
        return destroyed
    if (inactive := causes.diagnose_lifecycle(trace)) is not None:
        return inactive
    uncalled = diagnose_uncalled_setup(started_node(trace), "create_service")
    if (unreached := uncalled or diagnose_awaited_service(trace)) is not None:
        return unreached
    cause = Cause(
        "service missing",
        f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} not there",
        f"self.create_service(AddTwoInts, '{missing[0][1:]}', self.{missing[0][1:]}_callback)",
    )
    return with_applicable_step(cause, trace, lambda: service_steps.add_services(trace, missing))


def _is_similar(offered: str, missing: str) -> bool:
    return offered.casefold().endswith(missing) or missing[1:4] in offered.casefold()


def _first_step(trace: Trace, step: Callable[[Code], str | None]) -> str | None:
    """Return the step for the first of the learner's files that has one."""
    return next((found for code in learner_files(trace) if (found := step(code)) is not None), None)


def with_answer_step(cause: Cause, trace: Trace, service: str, stuck: Sequence[Frame] = ()) -> Cause:
    """Give a cause the step that lets a service answer."""
    if (unawaited := diagnose_unawaited(trace)) is not None:
        return with_applicable_step(unawaited, trace)
    found, at = tracebacks.last_traceback(trace), tracebacks.own_frame(stuck, trace.folder)
    if found is not None and found.frames[-1].function == "send_response":
        return replace(cause, hint=service_steps.return_response(trace, service) or cause.hint)
    if cause.name == names.NO_SPIN:
        return with_applicable_step(cause, trace)
    if at is not None and "sleep(" in at.code and found is None:
        step = (
            services.compute_results(trace, [service], whole=True)
            if _waits_for_ever(trace, at)
            else _first_step(trace, lambda code: steps.remove_calls(code, "sleep"))
        )
        return replace(cause, hint=step or cause.hint)
    if unawaited_names(trace):
        return replace(cause, hint=services.compute_results(trace, [service], whole=True) or cause.hint)
    if cause.name == names.INCOMPATIBLE_QOS:
        return with_applicable_step(cause, trace, lambda: _first_step(trace, service_steps.use_default_qos))
    if any("transient local' for service" in line.text for line in trace.output):  # a warning of rcl
        step = _first_step(trace, service_steps.use_default_qos)
        text = "its QoS is transient local, which no client with the default QoS offers: no request arrives"
        return replace(cause, name=names.INCOMPATIBLE_QOS, text=text, hint=step or cause.hint)
    wrong = services.sharing_callback(trace, service) if found is not None else [service]
    return with_applicable_step(cause, trace, lambda: services.compute_results(trace, wrong, whole=True))


def _waits_for_ever(trace: Trace, at: Frame) -> bool:
    """Whether a line is in a while loop that does nothing but wait."""
    loop = outermost(node_file(trace.sources.get(at.name, "")), at.line)
    return isinstance(loop, ast.While) and all(map(only_waits, loop.body))


def judge_operations(seen: ServiceCalls, simple: ServiceCalls) -> Verdict:
    """Judge `operations`. `simple`: the calls by which `services` is judged."""
    if judge_services(simple).status is Status.FAILED:
        return skipped("not judged, because `services` did not pass")
    return _judge_results(seen)


@with_applicable_steps
def _judge_results(seen: ServiceCalls) -> Verdict:
    expected = "right results, negative operands included"
    for answer in seen.answers:
        a, b = answer.request["a"], answer.request["b"]
        right = correct_result(answer.service, a, b)
        question = f"{answer.service}: {a} {OPERATOR_SIGNS[answer.service]} {b}"
        if answer.response is None:
            return failed(
                f"{question} = {right}",
                causes.describe_no_answer(seen.trace, answer.took_s),
                with_answer_step(
                    causes.diagnose_process(seen.trace)
                    or Cause(
                        "no answer",
                        "the service does not answer this call",
                        f"let the callback of {answer.service} finish, and return its response; if `services` "
                        "fails as well, it shows where the callback is stuck",
                    ),
                    seen.trace,
                    answer.service,
                ),
                causes.output_tail(seen.trace),
            )
        if answer.response["sum"] != right:
            return failed(
                f"{question} = {right}",
                f"{answer.response['sum']}",
                late_binding.diagnose_loop(seen.trace, seen.answers)
                or _with_computing_step(
                    _diagnose_negatives(answer, seen.answers)
                    or _diagnose_zero(answer, seen.answers)
                    or _diagnose_result(answer, right),
                    seen,
                ),
                [f"{name} answered {result}" for name, result in _operands_and_results(seen.of(answer.service))],
            )
    if late := _never_called(seen):
        return failed(expected, f"missing: {', '.join(late)}", _diagnose_missing(seen.trace, late))
    return passed(
        expected,
        f"{len(seen.answers)} calls",
        [f"{name} = {result}" for name, result in _operands_and_results(seen.answers)][:8],
    )


def _operands_and_results(answers: Sequence[CallAnswer]) -> list[tuple[str, Any]]:
    return [
        (f"{a.request['a']} {OPERATOR_SIGNS[a.service]} {a.request['b']}", a.response["sum"])
        for a in answers
        if a.response is not None
    ]


def _diagnose_negatives(answer: CallAnswer, answers: Sequence[CallAnswer]) -> Cause | None:
    """Diagnose a service that answers all calls with a negative operand alike, and all others correctly."""
    negative: list[tuple[int, int]] = []
    others: list[tuple[int, int]] = []
    for each in answers:
        if each.service == answer.service and each.response is not None:
            group = negative if min(each.request["a"], each.request["b"]) < 0 else others
            group.append((each.response["sum"], correct_result(each.service, each.request["a"], each.request["b"])))
    same = len({got for got, _ in negative}) == 1 and len({right for _, right in negative}) > 1
    wrong = sum(got != right for got, right in negative)
    if wrong < 2 or not others or not same or any(got != right for got, right in others):
        return None
    return Cause(
        "negative operands refused",
        f"{answer.service} answers {negative[0][0]} whenever an operand is negative, and is right otherwise",
        "take the test for negative numbers out of the callback: it computes with them as with any others",
    )


def _diagnose_zero(answer: CallAnswer, answers: Sequence[CallAnswer]) -> Cause | None:
    """Diagnose a service that refuses b = 0, which only a division must, and is right otherwise."""
    others = [each for each in answers if each.service == answer.service and each.request["b"] != 0 and each.response]
    right = [correct_result(each.service, each.request["a"], each.request["b"]) for each in others]
    if answer.request["b"] != 0 or [each.response["sum"] for each in others if each.response] != right:
        return None
    return Cause(
        "zero refused",
        f"{answer.service} computes with every other number, but not with b = 0, which only a division must refuse",
        "test for zero in the callback of /divide only",
    )


def _with_computing_step(cause: Cause, seen: ServiceCalls) -> Cause:
    """Give a cause the step that makes each service with a wrong answer compute its own result."""
    answers = [(each, correct_result(each.service, each.request["a"], each.request["b"])) for each in seen.answers]
    wrong = list(dict.fromkeys(a.service for a, right in answers if a.response and a.response["sum"] != right))
    return replace(cause, hint=services.compute_results(seen.trace, wrong) or cause.hint)


def _diagnose_result(answer: CallAnswer, right: int) -> Cause:
    """Guess the cause of a wrong result from its value."""
    assert answer.response is not None
    got, a, b = answer.response["sum"], answer.request["a"], answer.request["b"]
    name = answer.service
    others = [other for other in OPERATOR_SIGNS if other != name and correct_result(other, a, b) == got]
    if others and a:
        return Cause(
            "wrong result",
            f"this is what {others[0]} would answer",
            f"look at the sign in the callback of {name}, and at which callback belongs to which service",
        )
    if name == "/subtract" and got == b - a:
        return Cause("wrong result", "the operands are the wrong way round", "resp.sum = req.a - req.b")
    if got == -1 and name == "/divide":
        return Cause("float in an int field", "a / b is a float, and resp.sum takes whole numbers only", "use a // b")
    if (got - right) % 2**32 == 0:
        return Cause(
            "wrong result", "the result is cut off to 32 bits", "an int64 has 64: leave the numbers as they are"
        )
    if abs(got) == abs(right):
        return Cause("wrong result", "the sign is lost", "no abs(): negative numbers are numbers too")
    if got == 0:
        return Cause("wrong result", "the result is 0: is it put into resp.sum?", "set resp.sum before you return resp")
    return Cause("wrong result", f"{got} instead of {right}", f"look at the callback of {name}")


def judge_shutdown(seen: ServiceCalls) -> Verdict:
    shown_by = "services" if judge_services(seen).status is Status.FAILED else "operations"
    return ending.judge_ending(seen.trace, seen.ending, shown_by=shown_by)
