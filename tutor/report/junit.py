"""The report as JUnit XML for Jenkins, GitLab and GitHub's test reporters (follows Jenkins's junit-10.xsd)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.judge.verdict import Status
from tutor.report.plain import REMARKS_HEADING, details, evidence_lines, missing_lines, one_line, remark_lines

_MAX_LENGTH = 2000
_COUNT_ATTRIBUTES = (("failures", "failure"), ("errors", "error"), ("skipped", "skipped"))


def render(report: Report) -> str:
    """Render one test suite per exercise and one test case per criterion (see `add_cases`)."""
    root = new_document(report.duration_s)
    for exercise in report.exercises:
        facts = {
            **asdict(report.environment),
            "verdict": exercise.verdict.value,
            "submission": ", ".join(exercise.submission),
        }
        suite = add_suite(root, f"{exercise.id} {exercise.title}", exercise.duration_s, facts)
        add_cases(suite, exercise, f"ros-tutor.{exercise.id}")
        add_remarks(suite, [exercise])
    if not report.exercises:
        add_unjudged(add_suite(root, "check", report.duration_s, {}), "ros-tutor", report)
    return to_xml(root)


def new_document(duration_s: float) -> Element:
    """Return a document without suites."""
    return Element("testsuites", name="ros-tutor", time=_format_time(duration_s))


def add_suite(root: Element, name: str, duration_s: float, properties: Mapping[str, str]) -> Element:
    """Add a suite without cases."""
    suite = SubElement(root, "testsuite", name=one_line(name), time=_format_time(duration_s))
    element = SubElement(suite, "properties")
    for key, value in properties.items():
        SubElement(element, "property", name=key, value=one_line(value))
    return suite


def add_cases(suite: Element, exercise: ExerciseResult, classname: str, *, steps: bool = True) -> None:
    """Add a case per criterion; without `steps`, a failure says nothing of what to do about it.

    A bonus criterion that did not pass is reported as "skipped", since a failure would turn a passed check red. A
    required criterion of an exercise that was not handed in is a failure, since nothing else would turn the check red.
    """
    for criterion in exercise.criteria:
        _add_case(suite, exercise, criterion, classname, steps)


def add_remarks(suite: Element, exercises: Sequence[ExerciseResult]) -> None:
    """Add what works, but will bite. The schema wants it after all cases."""
    lines = []
    for exercise in exercises:
        if exercise.remarks:
            lines.append(REMARKS_HEADING if len(exercises) == 1 else f"{exercise.id}: {REMARKS_HEADING}")
            lines += [one_line(line, _MAX_LENGTH) for line in remark_lines(exercise)]
    if lines:
        SubElement(suite, "system-out").text = "\n".join(lines)


def add_unjudged(suite: Element, classname: str, report: Report) -> None:
    """Add one test that could not be judged: without any, readers of these files see nothing wrong."""
    time = _format_time(report.duration_s)
    case = SubElement(suite, "testcase", classname=one_line(classname), name="check", time=time)
    SubElement(case, "error", type="could not be judged", message=one_line(report.message))


def to_xml(root: Element) -> str:
    """Count the cases of each suite, and return the document."""
    for suite in root:
        suite.set("tests", str(len(suite.findall("testcase"))))
        for attribute, tag in _COUNT_ATTRIBUTES:
            suite.set(attribute, str(len(suite.findall(f"testcase/{tag}"))))
    for name in ("tests", "failures", "errors"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _add_case(
    suite: Element, exercise: ExerciseResult, criterion: CriterionResult, classname: str, steps: bool
) -> None:
    time = _format_time(criterion.duration_s)
    case = SubElement(suite, "testcase", classname=one_line(classname), name=one_line(criterion.id), time=time)
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
    for label, text in details(verdict, steps=steps):
        lines.append(f"{label}: {one_line(text, _MAX_LENGTH)}")
    lines += [f"  {line}" for line in evidence_lines(verdict)]
    if exercise.missing:
        lines += missing_lines(exercise)[1:]
    outcome.text = "\n".join(lines)


def _format_time(duration_s: float) -> str:
    return f"{max(duration_s, 0.0):.3f}"
