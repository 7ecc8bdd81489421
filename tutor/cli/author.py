"""`ros-tutor author check`: verify a course, for course authors."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli import context, grammar, terminal
from tutor.cli.errors import FAULT, INTERRUPTED, NOT_PASSED, PASSED
from tutor.errors import UsageError
from tutor.judge.wording import counted

if TYPE_CHECKING:
    from tutor.content import Course, Lesson, Problem
    from tutor.engine.proving import Proof
    from tutor.judge.check import Check

_ACTIONS = ("check",)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `check [EXERCISE...] [--static] [--submissions DIR]`."""
    parser.add_argument("action", metavar="ACTION", choices=_ACTIONS, help="check: verify lessons and their checks")
    parser.add_argument(
        "exercises", metavar="EXERCISE", nargs="*", help="only these (else all; with --lessons, its own)"
    )
    parser.add_argument("--static", action="store_true", help="only read; run no skeleton and no solution")
    parser.add_argument(
        "--submissions", metavar="DIR", type=Path, help="the test submissions (tests/submissions beside the lessons)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print one line per finding and a summary: first the static findings, then those from running the exercises."""
    from tutor.errors import ContentError

    try:
        course = context.load_course(arguments)
    except ContentError as error:
        terminal.out(f"{error}\n1 finding: the course cannot be read\n")
        return NOT_PASSED
    lessons = _choose_lessons(arguments, course)
    checks, findings = _load_checks(lessons)
    findings += _find_static_problems(arguments, course, lessons, checks)
    _print_findings(findings)
    runnable = [lesson for lesson in lessons if lesson.id in checks and _has_all_files(lesson)]
    proofs: Sequence[Proof] = ()
    if not arguments.static and runnable:
        proven = _prove(runnable, course)
        if proven is None:
            terminal.say("interrupted; nothing is left running")
            return INTERRUPTED
        proofs = proven
    unjudged = _print_proofs(proofs, findings)
    _print_summary(len(lessons), len(proofs), len(findings), unjudged)
    return NOT_PASSED if findings else FAULT if unjudged else PASSED


def _choose_lessons(arguments: argparse.Namespace, course: Course) -> list[Lesson]:
    if arguments.exercises:
        return list(dict.fromkeys(course.find(each) for each in arguments.exercises))
    extra: Path | None = getattr(arguments, "lessons", None)
    if extra is None:
        return list(course.lessons)
    own = (extra / "lessons").resolve()
    return [lesson for lesson in course.lessons if lesson.folder.resolve().parent == own]


def _load_checks(lessons: Sequence[Lesson]) -> tuple[dict[str, Check], list[Problem]]:
    from tutor.content import Problem
    from tutor.engine.modules import load_check

    checks: dict[str, Check] = {}
    findings = []
    for lesson in lessons:
        try:
            checks[lesson.id] = load_check(lesson)
        except Exception as error:  # whatever goes wrong while loading a check is a finding
            text = f"it cannot be loaded: {type(error).__name__}: {error}"
            findings.append(Problem(lesson.check, " ".join(text.split()), getattr(error, "hint", "")))
    return checks, findings


def _find_static_problems(
    arguments: argparse.Namespace, course: Course, lessons: Sequence[Lesson], checks: Mapping[str, Check]
) -> Iterator[Problem]:
    from tutor.content import Course
    from tutor.content.lint import lint_course
    from tutor.content.lint_checks import find_disagreements, find_stray_files
    from tutor.content.lint_commands import find_bad_commands
    from tutor.content.lint_submissions import find_bad_submissions
    from tutor.workspace import TEMPLATE

    template_files = {path.name for path in TEMPLATE.rglob("*.py")}
    yield from lint_course(Course(tuple(lessons), course.checklist))
    yield from find_stray_files(course, lessons)
    for lesson in lessons:
        if lesson.id in checks:
            yield from find_disagreements(lesson, checks[lesson.id])
        yield from find_bad_commands(lesson, template_files, partial(_usage_error, arguments.parser))
    root = _choose_submissions_folder(arguments, lessons)
    if root is not None:
        yield from find_bad_submissions(root, course, lessons)


def _choose_submissions_folder(arguments: argparse.Namespace, lessons: Sequence[Lesson]) -> Path | None:
    named: Path | None = arguments.submissions
    if named is not None and not named.is_dir():
        raise UsageError(f"--submissions {named}: there is no such folder")
    default = lessons[0].folder.parents[1] / "tests" / "submissions" if lessons else Path()
    if named is None and not default.is_dir():
        terminal.say(
            f"no test submissions in {default}, so these are not verified; name their folder with --submissions"
        )
        return None
    return named or default


def _usage_error(parser: argparse.ArgumentParser, argv: list[str]) -> str:
    """Return the usage error that `ros-tutor` reports for these arguments; empty if they are valid."""
    try:
        grammar.read(parser, argv)
    except UsageError as error:
        return str(error)
    return ""


def _has_all_files(lesson: Lesson) -> bool:
    return all(file.skeleton.is_file() and file.solution.is_file() for file in lesson.files)


def _prove(lessons: Sequence[Lesson], course: Course) -> Sequence[Proof] | None:
    from tutor.cli.judging import NoDisplay, interruptible
    from tutor.engine.proving import prove

    def report_progress(proof: Proof) -> None:
        result = proof.result
        terminal.say(f"{proof.lesson.id} {proof.kind}: {result.verdict.value} in {result.duration_s:.1f} s")

    return interruptible(lambda: prove(lessons, course, report_progress), NoDisplay())


def _print_proofs(proofs: Sequence[Proof], findings: list[Problem]) -> int:
    """Print the findings of the runs and add them to `findings`; return how many criteria could not be judged."""
    from tutor.content.proof import find_contradictions, unjudged_criteria

    unjudged = 0
    for proof in proofs:
        found = list(find_contradictions(proof.lesson, proof.kind, proof.result))
        findings += found
        _print_findings(found)
        for criterion in unjudged_criteria(proof.result):
            unjudged += 1
            why = " ".join(f"{criterion.verdict.cause}; {criterion.verdict.step}".split())
            terminal.out(f"{proof.lesson.id} {proof.kind}, {criterion.id}: could not be judged: {why}\n")
    return unjudged


def _print_findings(findings: Sequence[Problem]) -> None:
    for finding in findings:
        place = context.display_path(finding.file)
        terminal.out(" ".join(f"{place}: {finding.description}".split()) + "\n")


def _print_summary(lessons: int, run_count: int, findings: int, unjudged: int) -> None:
    found = counted(findings, "finding") if findings else "nothing is wrong"
    not_judged = f", {unjudged} could not be judged" if unjudged else ""
    runs = f", {run_count} runs" if run_count else ", nothing was run"
    terminal.out(f"{found}{not_judged}: {counted(lessons, 'exercise')}{runs}\n")
