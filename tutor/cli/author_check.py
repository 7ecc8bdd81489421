"""`ros-tutor author check`: read a course, run what it brings along, and print what is wrong."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tutor.cli import context, grammar, terminal
from tutor.cli.errors import FAULT, INTERRUPTED, NOT_PASSED, PASSED
from tutor.errors import CheckError, ContentError, UsageError
from tutor.judge.wording import counted

if TYPE_CHECKING:
    from tutor.content import Course, Lesson, Problem
    from tutor.content.courses import Courses
    from tutor.engine.verification import Job, Proof
    from tutor.judge.check import Check


class _Chosen(NamedTuple):
    """What to verify: lessons, and beginnings of the names of submissions; without any, all submissions."""

    lessons: list[Lesson]
    submissions: tuple[str, ...]


def run(arguments: argparse.Namespace) -> int:
    """Print one line per finding and a summary: first the static findings, then those from running the exercises."""
    from tutor.cli.author_predictions import run_programs
    from tutor.content import Problem, load_course
    from tutor.stop_signals import Stopped

    try:
        own = context.own_courses(arguments)
        course = load_course(own.folders)
    except ContentError as error:
        _print_findings([Problem.of(error)])
        terminal.out("1 finding: the course cannot be read\n")
        return NOT_PASSED
    chosen = _choose(arguments, course, own)
    checks, findings = _load_checks(chosen.lessons)
    folders = _find_submissions(arguments, chosen.lessons)
    findings += _find_static_problems(arguments, course, chosen.lessons, checks, folders)
    findings += _find_missing_manifests(own)
    _print_findings(findings)
    proofs: Sequence[Proof] = ()
    if not arguments.static:
        proven = _prove(arguments, course, chosen, checks, folders)
        if proven is None:
            terminal.say("interrupted; nothing is left running")
            return INTERRUPTED
        proofs = proven
    unjudged = _print_proofs(proofs, findings)
    programs = 0
    if not arguments.static and not chosen.submissions:
        try:
            programs, found = run_programs(chosen.lessons)
        except Stopped:
            terminal.say("interrupted; nothing is left running")
            return INTERRUPTED
        findings += found
        _print_findings(found)
    _print_summary(len(chosen.lessons), len(proofs) + programs, len(findings), unjudged)
    return NOT_PASSED if findings else FAULT if unjudged else PASSED


def _choose(arguments: argparse.Namespace, course: Course, own: Courses) -> _Chosen:
    if arguments.exercises:
        names = [name.partition("/")[::2] for name in arguments.exercises]
        lessons = list(dict.fromkeys(course.find(exercise) for exercise, _ in names))
        submissions = tuple(f"{course.find(exercise).id}/{rest}" for exercise, rest in names if rest)
        return _Chosen(lessons, submissions)
    return _Chosen([lesson for lesson in course.lessons if lesson.course or not own.folders], ())


def _load_checks(lessons: Sequence[Lesson]) -> tuple[dict[str, Check], list[Problem]]:
    from tutor.content import Problem
    from tutor.engine.loading import load_check

    checks: dict[str, Check] = {}
    findings = []
    for lesson in lessons:
        try:
            checks[lesson.id] = load_check(lesson)
        except CheckError as error:
            findings.append(Problem(error.file, f"your check: {error.problem}", line=error.line))
    return checks, findings


def _find_missing_manifests(own: Courses) -> Iterator[Problem]:
    from tutor.content import Problem
    from tutor.content.courses import FORMAT, MANIFEST, read_manifest

    for folder in own.folders:
        manifest = read_manifest(folder)
        if not manifest.stated:
            hint = f"write two lines into it: `format: {FORMAT}` and `name: {manifest.name}`"
            yield Problem(folder / MANIFEST, "this file is missing", hint)


def _find_static_problems(
    arguments: argparse.Namespace,
    course: Course,
    lessons: Sequence[Lesson],
    checks: Mapping[str, Check],
    submissions: Mapping[Path, list[Lesson]],
) -> Iterator[Problem]:
    from tutor.content import Course
    from tutor.content.lint import lint_course
    from tutor.content.lint_checks import find_disagreements, find_stray_files
    from tutor.content.lint_commands import find_bad_commands
    from tutor.content.lint_submissions import find_bad_submissions
    from tutor.engine.loading import load_catalogues
    from tutor.mistakes.pages import every_mistake
    from tutor.workspace import TEMPLATE

    template_files = {path.name for path in TEMPLATE.rglob("*.py")}
    yield from lint_course(Course(tuple(lessons), course.checklist))
    yield from find_stray_files(course, lessons)
    for lesson in lessons:
        if lesson.id in checks:
            yield from find_disagreements(lesson, checks[lesson.id])
        yield from find_bad_commands(lesson, template_files, partial(_usage_error, arguments.parser))
    known = every_mistake(load_catalogues(course))
    for folder, judged in submissions.items():
        yield from find_bad_submissions(folder, course, judged, known)


def _find_submissions(arguments: argparse.Namespace, lessons: Sequence[Lesson]) -> dict[Path, list[Lesson]]:
    """Return the folders with test submissions, each with the lessons that its submissions are to."""
    named: Path | None = arguments.submissions
    if named is not None:
        if not named.is_dir():
            raise UsageError(f"--submissions {named}: there is no such folder")
        return {named: list(lessons)}
    found: dict[Path, list[Lesson]] = {}
    for root in dict.fromkeys(lesson.folder.parents[1] for lesson in lessons):
        folder = next((root / name for name in ("submissions", "tests/submissions") if (root / name).is_dir()), None)
        if folder is None:
            terminal.say(
                f"no test submissions in {context.display_path(root / 'submissions')}, so nothing shows that wrong "
                "programs fail; name their folder with --submissions"
            )
        else:
            found[folder] = [lesson for lesson in lessons if lesson.folder.parents[1] == root]
    return found


def _usage_error(parser: argparse.ArgumentParser, argv: list[str]) -> str:
    """Return the usage error that `ros-tutor` reports for these arguments; empty if they are valid."""
    try:
        grammar.read(parser, argv)
    except UsageError as error:
        return str(error)
    return ""


def _prove(
    arguments: argparse.Namespace,
    course: Course,
    chosen: _Chosen,
    checks: Mapping[str, Check],
    submissions: Mapping[Path, list[Lesson]],
) -> Sequence[Proof] | None:
    """Run everything; return None if interrupted."""
    from tutor import private_folders
    from tutor.cli.interruptible_run import NoDisplay, interruptible
    from tutor.engine.verification import jobs_of_lessons, prove

    def report_progress(proof: Proof) -> None:
        result = proof.result
        terminal.say(f"{proof.job.name}: {result.verdict.value} in {result.duration_s:.1f} s")

    runnable = [lesson for lesson in chosen.lessons if lesson.id in checks and _has_all_files(lesson)]
    with private_folders.temporary("author") as scratch:
        jobs = [] if chosen.submissions else list(jobs_of_lessons(runnable, scratch))
        jobs += _jobs_of_submissions(arguments, chosen, runnable, submissions, scratch)
        return interruptible(lambda: prove(jobs, course, report_progress), NoDisplay()) if jobs else ()


def _jobs_of_submissions(
    arguments: argparse.Namespace,
    chosen: _Chosen,
    runnable: Sequence[Lesson],
    submissions: Mapping[Path, list[Lesson]],
    scratch: Path,
) -> Iterator[Job]:
    """Yield the jobs of the test submissions.

    The hundreds to our own exercises are judged by `python -m tests.soundness`, and here only when named.
    """
    from tutor.content.lint_submissions import find_cases
    from tutor.content.loader import BUNDLED
    from tutor.engine.verification import job_of_case
    from tutor.ros.environment import detect

    for folder, lessons in submissions.items():
        ours = folder == BUNDLED / "tests" / "submissions"
        for lesson in (lesson for lesson in lessons if lesson in runnable):
            for case in find_cases(folder, lesson):
                wanted = str(case).startswith(chosen.submissions) if chosen.submissions else not ours
                if wanted and case.expected.ros in ("", detect().kind):
                    job = job_of_case(lesson, case, scratch)
                    if job is not None:
                        yield job


def _has_all_files(lesson: Lesson) -> bool:
    return all(file.skeleton.is_file() and file.solution.is_file() for file in lesson.files)


def _print_proofs(proofs: Sequence[Proof], findings: list[Problem]) -> int:
    """Print the findings of the runs and add them to `findings`; return how many criteria could not be judged."""
    from tutor.content.proof import find_contradictions, find_wrong_verdicts, unjudged_criteria

    unjudged = 0
    told: set[str] = set()
    for proof in proofs:
        job, result = proof.job, proof.result
        if job.case is not None:
            found = list(find_wrong_verdicts(job.case, result, proof.left))
        else:
            found = list(find_contradictions(job.lesson, job.kind, result))
        findings += found
        _print_findings(found)
        for criterion in unjudged_criteria(result):
            if criterion.verdict.cause.startswith(CheckError.BEGINNING):
                cause = criterion.verdict.cause.removeprefix(CheckError.BEGINNING)
                if cause not in told:
                    told.add(cause)
                    findings.append(_print_authors_fault(cause, job.name, criterion.id))
                continue
            if job.case is not None and job.case.expected.exit == FAULT:
                continue
            unjudged += 1
            why = " ".join(f"{criterion.verdict.cause}; {criterion.verdict.step}".split())
            terminal.out(f"{job.name}, {criterion.id}: could not be judged: {why}\n")
    return unjudged


def _print_authors_fault(cause: str, job: str, criterion: str) -> Problem:
    """Print an error that the author's check raised while it judged, and return it as a finding."""
    from tutor.content import Problem

    place, _, problem = cause.partition(": ")
    file, _, line = place.rpartition(":")
    known = line.isdecimal()
    finding = Problem(
        Path(file if known else place),
        f"your check: {problem}",
        f"it happened on {criterion} of {job}",
        int(line) if known else None,
    )
    _print_findings([finding])
    return finding


def _print_findings(findings: Sequence[Problem]) -> None:
    for finding in findings:
        place = f"{context.display_path(finding.file)}{finding.line_suffix}"
        terminal.out(" ".join(f"{place}: {finding.description}".split()) + "\n")


def _print_summary(lessons: int, run_count: int, findings: int, unjudged: int) -> None:
    found = counted(findings, "finding") if findings else "nothing is wrong"
    not_judged = f", {unjudged} could not be judged" if unjudged else ""
    runs = f", {counted(run_count, 'run')}" if run_count else ", nothing was run"
    terminal.out(f"{found}{not_judged}: {counted(lessons, 'exercise')}{runs}\n")
