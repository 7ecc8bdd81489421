"""I1.3: the verdict on a division by zero."""

from __future__ import annotations

import re
from dataclasses import replace

from checks.i1_3 import division_by_zero, service_steps, services
from checks.i1_3.code import with_applicable_step
from checks.i1_3.facts import (
    ENDED_BY_A_CALL,
    SAYS_ERROR,
    Division,
    correct_result,
    find_complaints,
)
from checks.i1_3.judges import with_answer_step
from checks.i1_3.rewriting import with_applicable_steps
from tutor.judge import causes, tracebacks
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed, skipped

_LOG_CALL = re.compile(r"\.(debug|info|warn|warning|error|fatal)\(")


def _with_guard_step(cause: Cause, trace: Trace) -> Cause:
    """Give a cause the step that lets /divide answer and log an error if b is 0."""
    found = tracebacks.last_traceback(trace)
    if found is not None and found.frames[-1].function == "send_response":
        return replace(cause, hint=service_steps.return_response(trace, "/divide") or cause.hint)
    own = found.own(trace.folder) if found is not None else None
    logs = own is not None and _LOG_CALL.search(own.code) is not None
    if found is not None and (logs or found.type in ("AttributeError", "NameError")):  # of the error branch itself
        return with_applicable_step(cause, trace, lambda: services.guard_division(trace))
    in_helper = found is not None and found.type == "ZeroDivisionError" and not services.find_callback(trace, "/divide")
    helper = division_by_zero.return_zero(trace) if in_helper else None
    return replace(cause, hint=helper or services.guard_division(trace) or cause.hint)


def _result(answer: CallAnswer) -> object:
    return answer.response["sum"] if answer.response is not None else None


@with_applicable_steps
def judge_division(seen: Division) -> Verdict:
    """Judge `divide-by-zero`."""
    expected = "a division by zero gets an answer, the node reports it as an error, and the next calls succeed"
    if seen.by_zero is None and seen.before is not None and seen.trace.exit is not None:
        return skipped(ENDED_BY_A_CALL)
    if seen.before is None or seen.by_zero is None:
        return failed(
            expected,
            "/divide does not answer even 84 ÷ 7",
            with_answer_step(
                causes.diagnose_process(seen.trace)
                or Cause("no answer", "the service does not answer", "see `services`"),
                seen.trace,
                "/divide",
            ),
            causes.output_tail(seen.trace),
        )
    if seen.by_zero.response is None:
        cause = causes.diagnose_process(seen.trace) or Cause(
            "no answer", "the callback does not answer when b is 0", "return the response in that case too"
        )
        cause = _with_guard_step(cause, seen.trace)
        return failed(
            expected,
            f"10 ÷ 0: {causes.describe_no_answer(seen.trace, seen.by_zero.took_s)}",
            cause,
            causes.output_tail(seen.trace),
        )
    complaints = find_complaints(seen.ordinary, seen.logged)
    # The last log messages of a node that exits may never reach us: in that case, report the exit instead.
    has_exited = seen.trace.exit is not None and any(answer.response is None for answer in seen.after)
    if not complaints and not has_exited:
        if _result(seen.before) != correct_result("/divide", **seen.before.request):
            cause = Cause(
                "no error message",
                f"no error is reported, since /divide does not divide: 84 ÷ 7 is answered {_result(seen.before)}",
                services.compute_results(seen.trace, ["/divide"]) or "let /divide divide first: see `operations`",
            )
            observed = f"answered {seen.by_zero.response['sum']}, without a word about an error"
            return failed(expected, observed, cause, [str(log) for log in seen.logged])
        printed = causes.diagnose_printed(seen.trace, SAYS_ERROR.search, "the error", after=seen.at_end)
        cause = printed or Cause(
            "no error message",
            "nothing that the node logs reports an error",
            "in the callback of /divide, where b is 0, log an error before you return the response",
        )
        trace = seen.trace
        cause = with_applicable_step(
            cause, trace, lambda: division_by_zero.log_division_by_zero(trace), lambda: services.guard_division(trace)
        )
        return failed(
            expected,
            f"answered {seen.by_zero.response['sum']}, without a word about an error",
            cause,
            [str(log) for log in seen.logged],
        )
    divides = _result(seen.before) == correct_result("/divide", **seen.before.request)
    for answer in seen.after:
        a, b = answer.request["a"], answer.request["b"]
        if answer.response is None:
            cause = causes.diagnose_process(seen.trace) or Cause(
                "no answer",
                "the node no longer answers after a division by zero",
                "let the node go on: only log, and answer, whatever a is",
            )
            cause = _with_guard_step(cause, seen.trace)
            return failed(expected, f"after it, {a} ÷ {b} got no answer", cause, causes.output_tail(seen.trace))
        if b and divides and answer.response["sum"] != correct_result("/divide", a, b):
            cause = Cause(
                "wrong result",
                "the node divides correctly until it is asked to divide by zero",
                "let a division by zero change nothing: only log, and answer",
            )
            cause = _with_guard_step(cause, seen.trace)
            return failed(expected, f"after it, {a} ÷ {b} was answered {answer.response['sum']}", cause)
    return passed(
        expected,
        f"answered {seen.by_zero.response['sum']}, and {len(seen.after)} calls after it",
        [str(complaints[0])],
    )
