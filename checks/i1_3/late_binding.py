"""I1.3: services that all compute the result of the same one, since their callbacks are made in a loop."""

from __future__ import annotations

from collections.abc import Sequence

from checks.i1_3.facts import OPERATOR_SIGNS, correct_result
from tutor.judge.causes.late_binding import diagnose_late_binding
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.verdict import Cause


def diagnose_loop(trace: Trace, answers: Sequence[CallAnswer]) -> Cause | None:
    """Diagnose services that all compute the same because functions made in a loop read its variables when called."""
    usable = [each for each in answers if each.response is not None and each.request["a"] and each.request["b"]]
    if len({each.service for each in usable}) < 2:
        return None
    same = [
        name
        for name in OPERATOR_SIGNS
        if all(each.response and each.response["sum"] == _result(name, each) for each in usable)
    ]
    return diagnose_late_binding(trace, f"all services compute what {same[0]} should: ") if same else None


def _result(service: str, answer: CallAnswer) -> int:
    return correct_result(service, answer.request["a"], answer.request["b"])
