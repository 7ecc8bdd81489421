"""Compares the verdict on a test submission with what its `expect.yaml` says. Pure functions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum

from tutor.content.submissions import Expected
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status


class Error(Enum):
    """How a verdict is wrong."""

    FALSE_PASS = "false pass"
    FALSE_FAILURE = "false failure"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class Deviation:
    """One way in which a result is not what was expected. `criterion` is empty if it is about several."""

    criterion: str
    text: str
    error: Error = Error.OTHER


def find_deviations(expected: Expected, result: ExerciseResult) -> Iterator[Deviation]:
    """Yield each deviation from what is expected (see tests/submissions/README.md)."""
    some_failed = any(criterion.verdict.status in (Status.FAILED, Status.ERROR) for criterion in result.criteria)
    told = {criterion.id: criterion.verdict for criterion in result.criteria}
    for criterion in result.criteria:
        root = told.get(criterion.verdict.same_as)  # a cause is told once
        if root is not None:
            verdict = replace(criterion.verdict, cause=root.cause, mistake=root.mistake)
            criterion = replace(criterion, verdict=verdict)
        yield from _of_criterion(criterion, expected, some_failed)
    any_of = expected.fails_any
    if any_of and not any(c.id in any_of and c.verdict.status is Status.FAILED for c in result.criteria):
        yield Deviation("", f"one of {', '.join(sorted(any_of))} should fail", Error.FALSE_PASS)


def _of_criterion(criterion: CriterionResult, expected: Expected, some_failed: bool) -> Iterator[Deviation]:
    name, status, cause = criterion.id, criterion.verdict.status, criterion.verdict.cause
    described = f"{name} {status.value}: {' | '.join(filter(None, (criterion.verdict.observed, cause)))}"
    must_fail = name in (*expected.fails, *expected.bonus_failed)
    if status is Status.ERROR and expected.exit == 3:
        return
    if status is Status.ERROR:
        yield Deviation(name, f"not judged: {described}")
    elif must_fail and status is not Status.FAILED:
        error = Error.FALSE_PASS if status is Status.PASSED else Error.OTHER
        yield Deviation(name, f"should fail: {described}", error)
    elif must_fail or name in expected.fails_any:
        if status is Status.FAILED:
            yield from _of_diagnosis(criterion, expected)
    elif name in expected.not_passed:
        if status is Status.PASSED:
            yield Deviation(name, f"should not pass: {described}", Error.FALSE_PASS)
    elif name not in expected.either and not _is_acceptable(status, some_failed):
        yield Deviation(name, f"should pass: {described}", Error.FALSE_FAILURE)


def _is_acceptable(status: Status, some_failed: bool) -> bool:
    """Return whether this status is fine for a criterion that no key names: skipping needs one that was not met."""
    return status is Status.PASSED or (status is Status.SKIPPED and some_failed)


def _of_diagnosis(criterion: CriterionResult, expected: Expected) -> Iterator[Deviation]:
    name, verdict = criterion.id, criterion.verdict
    causes = _wanted(expected.causes, name, expected)
    if causes and not any(text.casefold() in verdict.cause.casefold() for text in causes):
        yield Deviation(name, f"{name}: cause is “{verdict.cause}”, not {' or '.join(causes)}")
    mistakes = _wanted(expected.mistakes, name, expected)
    if mistakes and verdict.mistake not in mistakes:
        yield Deviation(name, f"{name}: mistake is {verdict.mistake or 'none'}, not {' or '.join(mistakes)}")


def _wanted(texts: Mapping[str, tuple[str, ...]], criterion: str, expected: Expected) -> tuple[str, ...]:
    """Return the texts for one criterion. Those for all that fail do not hold for a bonus."""
    general = () if criterion in expected.bonus_failed else texts.get("", ())
    return texts.get(criterion, general)
