"""The report as JUnit XML for Jenkins, GitLab and GitHub's test reporters (follows Jenkins's junit-10.xsd)."""

from __future__ import annotations

from dataclasses import asdict
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.judge.verdict import Status
from tutor.report.plain import REMARKS_HEADING, details, evidence_lines, missing_lines, one_line, remark_lines

_MAX_LENGTH = 2000
_COUNT_ATTRIBUTES = (("failures", "failure"), ("errors", "error"), ("skipped", "skipped"))


def render(report: Report) -> str:
    """Render one test suite per exercise and one test case per criterion.

    A bonus criterion that did not pass is reported as "skipped", since a failure would turn a passed check red. A
    required criterion of an exercise that was not handed in is a failure, since nothing else would turn the check red.
    """
    root = Element("testsuites", name="ros-tutor", time=_format_time(report.duration_s))
    for exercise in report.exercises:
        _add_suite(root, exercise, report)
    if not report.exercises:
        _add_message(root, report)
    for name in ("tests", "failures", "errors"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _add_suite(root: Element, exercise: ExerciseResult, report: Report) -> None:
    name = one_line(f"{exercise.id} {exercise.title}")
    suite = SubElement(root, "testsuite", name=name, time=_format_time(exercise.duration_s))
    properties = SubElement(suite, "properties")
    facts = {
        **asdict(report.environment),
        "verdict": exercise.verdict.value,
        "submission": ", ".join(exercise.submission),
    }
    for name, value in facts.items():
        SubElement(properties, "property", name=name, value=one_line(value))
    for criterion in exercise.criteria:
        _add_case(suite, exercise, criterion)
    if exercise.remarks:
        lines = [REMARKS_HEADING, *(one_line(line, _MAX_LENGTH) for line in remark_lines(exercise))]
        SubElement(suite, "system-out").text = "\n".join(lines)
    suite.set("tests", str(len(exercise.criteria)))
    for attribute, tag in _COUNT_ATTRIBUTES:
        suite.set(attribute, str(len(suite.findall(f"testcase/{tag}"))))


def _add_message(root: Element, report: Report) -> None:
    """Add one test that could not be judged: without any, readers of these files see nothing wrong."""
    time = _format_time(report.duration_s)
    suite = SubElement(root, "testsuite", name="check", time=time, tests="1", failures="0", errors="1", skipped="0")
    SubElement(suite, "properties")
    case = SubElement(suite, "testcase", classname="ros-tutor", name="check", time=time)
    SubElement(case, "error", type="could not be judged", message=one_line(report.message))


def _add_case(suite: Element, exercise: ExerciseResult, criterion: CriterionResult) -> None:
    case = SubElement(
        suite,
        "testcase",
        classname=one_line(f"ros-tutor.{exercise.id}"),
        name=one_line(criterion.id),
        time=_format_time(criterion.duration_s),
    )
    verdict = criterion.verdict
    if verdict.passed:
        return
    message = one_line(verdict.cause or verdict.observed or verdict.status.value)
    if criterion.bonus:
        outcome = SubElement(case, "skipped", message=f"bonus, {verdict.status.value}: {message}")
    elif verdict.status is Status.SKIPPED and not exercise.missing:
        outcome = SubElement(case, "skipped", message=message)
    elif verdict.status is Status.ERROR:
        outcome = SubElement(case, "error", type="could not be judged", message=message)
    else:
        outcome = SubElement(case, "failure", type=verdict.mistake or "failed", message=message)
    lines = [one_line(criterion.text)]
    for label, text in details(verdict):
        lines.append(f"{label}: {one_line(text, _MAX_LENGTH)}")
    lines += [f"  {line}" for line in evidence_lines(verdict)]
    if exercise.missing:
        lines += missing_lines(exercise)[1:]
    outcome.text = "\n".join(lines)


def _format_time(duration_s: float) -> str:
    return f"{max(duration_s, 0.0):.3f}"
