"""I1.3: the next step for a client that failed: the smallest edit that fixes the cause, or a rewrite."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from checks.i1_3 import client_requests, rewriting, service_steps, steps
from checks.i1_3.code import Code, learner_files, with_applicable_step
from checks.i1_3.facts import OPERATOR_SIGNS, ClientRun
from tutor.judge import source, tracebacks
from tutor.judge.verdict import Cause

_Step = Callable[[Code, Cause, ClientRun], str | None]


def _remove_calls(code: Code, _cause: Cause, _seen: ClientRun, names: Sequence[str] = ("_exit",)) -> str | None:
    return steps.remove_calls(code, *names)


_STEPS: Mapping[str, Sequence[_Step]] = {
    "service not waited for": [lambda code, *_: client_requests.wait_for_services(code)],
    "waits too short a time": [_remove_calls, lambda code, *_: client_requests.lengthen_waits(code)],
    "non-zero exit": [lambda code, *_: steps.remove_arguments(code) or steps.end_with_zero(code)],
    "coroutine not awaited": [
        lambda code, cause, _: client_requests.make_synchronous(code, cause.text.partition(" ")[0])
    ],
    "incompatible QoS": [lambda code, *_: service_steps.use_default_qos(code)],
    "thread still running": [lambda code, *_: steps.join_thread(code)],
    "not called": [
        lambda code, *_: steps.remove_arguments(code),
        _remove_calls,
        lambda code, _, seen: steps.add_to_list(code, missing_services(seen)),
    ],
}
"""The smallest steps for each cause, by the cause's name."""


def with_client_step(cause: Cause, seen: ClientRun) -> Cause:
    """Give a cause a step that can be followed word for word.

    In this order: one for the cause itself, one that waits for each answer, or a rewrite of the client.
    """
    assert seen.trace is not None
    trace, own = seen.trace, tracebacks.own_frame(seen.stuck, seen.trace.folder)
    found = tracebacks.last_traceback(trace)
    raised = own_frame.code if found is not None and (own_frame := found.own(trace.folder)) is not None else ""
    if cause.name == "did not end" and own is not None and not missing_services(seen):
        files = [code for code in learner_files(trace) if code.file == own.name]
        if (hint := next(filter(None, (steps.shorten_loop(code, own.line) for code in files)), None)) is not None:
            return replace(cause, hint=hint)
    fixes = _fixes_of(cause, seen, own)
    fix_first = bool(fixes) or _is_due_to_no_answer(found)  # before the hint that the cause has already
    if "input(" in raised or (own is not None and "input(" in own.code):
        fixes, fix_first = [lambda code, *_: steps.remove_input(code)], True
    each_file = [partial(step, code, cause, seen) for step in fixes for code in learner_files(trace)]
    each_file = [*(partial(client_requests.negate_waits, code) for code in learner_files(trace)), *each_file]
    not_sent = cause.name in ("wrong service name", "wrong type", "not called", "waits too short a time")
    waits = (
        []
        if not_sent
        else [
            *(partial(client_requests.spin_while_polling, code) for code in learner_files(trace)),
            *(partial(client_requests.wait_for_answers, code, trace) for code in learner_files(trace)),
        ]
    )
    file = next(iter(learner_files(trace)), Code(""))
    last = [partial(rewriting.rewrite_client, file)] if file.file else []
    if fix_first and (hint := next((hint for step in (*each_file, *waits) if (hint := step()) is not None), None)):
        return replace(cause, hint=hint)
    return with_applicable_step(cause, trace, *each_file, *waits, *last)


def _fixes_of(cause: Cause, seen: ClientRun, own: tracebacks.Frame | None) -> Sequence[_Step]:
    """The smallest steps for a cause. `own`: where in the learner's code the client is stuck."""
    if cause.name != "did not end":
        return _STEPS.get(cause.name, [])
    fixes: Sequence[_Step] = []
    if own is not None and "sleep(" in own.code:
        fixes = [lambda code, *_: client_requests.spin_while_polling(code), partial(_remove_calls, names=("sleep",))]
        if not missing_services(seen):
            function = own.function
            fixes = [lambda code, *_: steps.make_thread_daemon(code, function), *fixes]
    elif not missing_services(seen) and seen.trace is not None and source.calls(seen.trace, "Thread"):
        joined = own if own is not None and ".join(" in own.code else None
        fixes = [
            lambda code, *_: steps.shut_down_rclpy(code, joined.line if joined and joined.name == code.file else 0)
        ]
    if own is not None and ".wait(" in own.code:
        line, file_name = own.line, own.name
        fixes = [lambda code, *_: client_requests.set_event(code, line) if code.file == file_name else None, *fixes]
    return fixes


def _is_due_to_no_answer(found: tracebacks.Traceback | None) -> bool:
    """Whether an exception comes from using an answer that had not arrived yet."""
    used_itself = found is not None and "'Future'" in found.message and "'_condition'" not in found.message
    return found is not None and (uses_none(found) or used_itself or found.type.endswith(("Timeout", "TimeoutError")))


def uses_none(found: tracebacks.Traceback) -> bool:
    """Whether None was used as an answer; `with rclpy.init()` uses it as something else."""
    return "'NoneType'" in found.message and "context manager" not in found.message


def missing_services(seen: ClientRun) -> list[str]:
    """The services that got no request."""
    called = {served.service for served in seen.served}
    return [name for name in OPERATOR_SIGNS if name not in called]
