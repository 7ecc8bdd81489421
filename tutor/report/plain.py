"""Marks and phrases shared by all formats."""

from __future__ import annotations

import re

from tutor.invocation import command
from tutor.judge.result import Environment, ExerciseResult, Remark, Report
from tutor.judge.verdict import Status, Verdict
from tutor.terminal_text import printable

MARKS = {Status.PASSED: "✓", Status.FAILED: "✗", Status.SKIPPED: "-", Status.ERROR: "!"}


def one_line(text: str, max_length: int = 300) -> str:
    """Return `printable` text as one line, shortened to `max_length` characters with "..."."""
    text = " ".join(printable(text).split())
    return text if len(text) <= max_length else f"{text[: max_length - 3].rstrip()}..."


def describe_waiting(doing: str, so_far: str, max_length: int) -> str:
    """Describe a criterion that is still waiting: what is being done to the node, and the provisional result so far.

    If both do not fit into `max_length` characters, only the provisional result is returned.
    """
    if not so_far:
        return doing
    known = f"so far: {one_line(so_far)}"
    both = f"{doing}; {known}" if doing else known
    return both if len(both) <= max_length else known


def evidence_lines(verdict: Verdict, max_length: int = 500) -> list[str]:
    """Return the evidence as `printable` lines of at most `max_length` characters."""
    lines = [line for text in verdict.evidence for line in printable(text).split("\n")]
    return [line if len(line) <= max_length else f"{line[: max_length - 3]}..." for line in lines]


def details(verdict: Verdict, *, steps: bool = True) -> list[tuple[str, str]]:
    """Return the non-empty texts of a verdict as (label, text) pairs, without the evidence.

    Without `steps`, what to do about a failure is left out.
    """
    advice = (
        ("next step", verdict.step),
        ("more", command("explain", verdict.mistake) if verdict.mistake and not verdict.same_as else ""),
    )
    pairs = (
        ("expected", verdict.expected),
        ("observed", verdict.observed),
        ("why", verdict.cause),
        *(advice if steps else ()),
    )
    return [(label, printable(text).strip()) for label, text in pairs if text.strip()]


REMARKS_HEADING = "This works, but …"


def remark_lines(exercise: ExerciseResult) -> list[str]:
    """Return a line for each remark: where, and what. The heading is `REMARKS_HEADING`."""
    several = len(exercise.submission) > 1
    return [printable(_describe(remark, several=several)) for remark in exercise.remarks]


def _describe(remark: Remark, *, several: bool) -> str:
    line = f"line {remark.line}"
    text = remark.text if re.search(rf"\b{line}\b", remark.text) or not remark.line else f"{line}: {remark.text}"
    return f"{remark.file}: {text}" if several else f"{text[:1].upper()}{text[1:]}"


def missing_lines(exercise: ExerciseResult) -> list[str]:
    """Return why there was nothing to judge, and what to do or what was looked for and found, as `printable` lines."""
    hint = exercise.criteria[0].verdict.step
    lines = [f"{exercise.missing}; {hint}" if hint else exercise.missing]
    if exercise.lookup is not None and not hint:
        lines.append(f"looked for: {', '.join(exercise.lookup.looked_for)}")
        lines.append(f"found there: {', '.join(exercise.lookup.found) or 'nothing'}")
    return [printable(line) for line in lines]


def isolation_lines(report: Report) -> list[str]:
    """Return a line for what was isolated and one for what was not; none if isolation was not requested."""
    lines = []
    for label, stands in (("isolated", True), ("not isolated", False)):
        if walls := [f"{wall.name} ({wall.detail})" for wall in report.isolation if wall.stands is stands]:
            lines.append(f"{label}: {'; '.join(walls)}")
    return lines


def tally(exercise: ExerciseResult) -> str:
    """Return how many criteria passed: "4 of 6 passed, bonus 1 of 1"."""
    required = [c.verdict.passed for c in exercise.criteria if not c.bonus]
    bonus = [c.verdict.passed for c in exercise.criteria if c.bonus]
    text = f"{sum(required)} of {len(required)} passed" if required else ""
    extra = f"bonus {sum(bonus)} of {len(bonus)}" if bonus else ""
    return ", ".join(part for part in (text, extra) if part)


def seconds(duration_s: float) -> str:
    """Format a duration: "3.9 s"."""
    return f"{duration_s:.1f} s"


def describe(environment: Environment) -> str:
    """Describe the environment of a check in one line."""
    return f"ROS 2 {environment.ros_distro} ({environment.ros}), {environment.rmw}, ros-tutor {environment.ros_tutor}"
