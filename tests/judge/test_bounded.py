"""Verdicts are of bounded length, whatever a learner's program has written."""

from __future__ import annotations

import json

from tests.failures import failure
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Report
from tutor.judge.verdict import bounded
from tutor.report import render


def test_a_report_is_small_whatever_it_contains() -> None:
    big = "\x07" * 1_000_000
    verdict = bounded(failure(big, big, ("wrong content", big, big), [big] * 1000))
    criteria = tuple(CriterionResult(str(n), "text", False, verdict, 1.0) for n in range(7))
    report = Report(
        Environment("jazzy", "bundled", "rmw", "0"), (ExerciseResult("i1.1", "x", ("x.py",), criteria, 1.0),), 1.0
    )
    for written in ("json", "text", "junit", "markdown"):
        assert len(render(report, written).encode()) < 1_000_000
    assert json.loads(render(report, "json"))["exercises"][0]["criteria"][0]["cause"].endswith("...")


def test_a_short_verdict_is_unchanged() -> None:
    verdict = failure("a", "b", ("c", "d", "line 1 becomes: e"), ["f"])
    assert bounded(verdict) == verdict
