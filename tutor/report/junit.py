"""The report as JUnit XML, as continuous integration services read it."""

from __future__ import annotations

from dataclasses import asdict
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.judge.verdict import Status
from tutor.report.plain import details, printable


def render(report: Report) -> str:
    """Write one test suite for each exercise, one test case for each criterion.

    A bonus criterion that did not pass is "skipped" here, since a failure would turn a passed check red.
    """
    root = Element("testsuites", name="ros-tutor", time=_time(report.duration_s))
    for exercise in report.exercises:
        _suite(root, exercise, report)
    for name in ("tests", "failures", "errors", "skipped"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _suite(root: Element, exercise: ExerciseResult, report: Report) -> None:
    suite = SubElement(root, "testsuite", name=f"{exercise.id} {exercise.title}", time=_time(exercise.duration_s))
    properties = SubElement(suite, "properties")
    for name, value in {**asdict(report.environment), "verdict": exercise.verdict.value}.items():
        SubElement(properties, "property", name=name, value=value)
    for criterion in exercise.criteria:
        _case(suite, exercise, criterion)
    suite.set("tests", str(len(exercise.criteria)))
    for name, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(name, str(len(suite.findall(f"testcase/{tag}"))))


def _case(suite: Element, exercise: ExerciseResult, criterion: CriterionResult) -> None:
    case = SubElement(
        suite,
        "testcase",
        classname=f"ros-tutor.{exercise.id}",
        name=criterion.id,
        time=_time(criterion.duration_s),
    )
    verdict = criterion.verdict
    if verdict.passed:
        return
    tag = {Status.FAILED: "failure", Status.ERROR: "error"}.get(verdict.status, "skipped")
    message = printable(verdict.cause or verdict.observed)
    if criterion.bonus:
        tag, message = "skipped", f"bonus, {verdict.status.value}: {message}"
    outcome = SubElement(case, tag, message=message)
    lines = [criterion.text, *(f"{label}: {text}" for label, text in details(verdict))]
    lines += [f"  {printable(line)}" for line in verdict.evidence]
    outcome.text = "\n".join(lines)


def _time(duration_s: float) -> str:
    return f"{duration_s:.3f}"
