"""A report that was written as JSON can be read again, whatever it holds."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Lookup, Remark, Report, Restriction
from tutor.judge.verdict import Status, Verdict, fault, passed, skipped
from tutor.report.json_report import parse, render

ENVIRONMENT = Environment(ros_distro="jazzy", ros="bundled", rmw="rmw_fastrtps_cpp", ros_tutor="0.1.0")
FAILED = Verdict(Status.FAILED, "5 Hz", "1 Hz", "no spin: x", "call spin()", ("line 1", "  line 2"), mistake="no-spin")
SAME = replace(FAILED, cause="for the same reason as `a`", step="", same_as="a", evidence=())


def exercise(*verdicts: Verdict, identity: str = "i1.1") -> ExerciseResult:
    criteria = tuple(
        CriterionResult(f"c{number}", f"Text {number}", number % 2 == 1, verdict, 1.25)
        for number, verdict in enumerate(verdicts)
    )
    return ExerciseResult(identity, "Sensor Publisher", ("a.py", "b.py"), criteria, 3.5)


JUDGED = exercise(passed("x", "y", ("z",)), FAILED, SAME, skipped("not judged"), fault("no domain", "close others"))
MISSING = replace(exercise(Verdict(Status.SKIPPED, cause="nothing was handed in")), submission=())
REPORTS = {
    "judged": Report(ENVIRONMENT, (JUDGED,), 4.25),
    "several": Report(ENVIRONMENT, (JUDGED, exercise(FAILED, identity="i2.2")), 4.25),
    "remarks": Report(ENVIRONMENT, (replace(JUDGED, remarks=(Remark("late", "line 3", "a.py", 3),)),), 1.0),
    "isolated": Report(ENVIRONMENT, (JUDGED,), 1.0, (Restriction("user", True, "a"), Restriction("net", False, "b"))),
    "missing": Report(ENVIRONMENT, (replace(MISSING, lookup=Lookup(("a.py",), ("b.py", "c/"))),), 0.0),
    "nothing": Report(ENVIRONMENT, (), 0.0, message="the check was silent for 120 s"),
}


@pytest.mark.parametrize("report", REPORTS.values(), ids=REPORTS.keys())
def test_nothing_that_a_report_shows_is_lost(report: Report) -> None:
    text = render(report)
    assert parse(json.loads(text)) == report
    assert render(parse(json.loads(text))) == text


def test_without_a_lookup_there_is_an_empty_one() -> None:
    again = parse(json.loads(render(Report(ENVIRONMENT, (MISSING,), 0.0))))
    assert again.exercises == (replace(MISSING, lookup=Lookup((), ())),)
    assert again.exercises[0].missing == "nothing was handed in"


@settings(max_examples=50)
@given(st.text(), st.floats(0, 1e6))
def test_a_second_time_nothing_changes(text: str, seconds: float) -> None:
    verdict = Verdict(Status.FAILED, text, text, text, text, (text,))
    judged = replace(exercise(verdict), duration_s=seconds)
    once = parse(json.loads(render(Report(ENVIRONMENT, (judged,), seconds, message=text))))
    assert parse(json.loads(render(once))) == once


@pytest.mark.parametrize("document", [{}, {"schema": "ros-tutor/report/2"}, {"schema": "ros-tutor/report/1"}])
def test_what_is_no_report(document: dict[str, str]) -> None:
    with pytest.raises(ValueError, match=r"not a ros-tutor/report/1|it is damaged"):
        parse(document)
