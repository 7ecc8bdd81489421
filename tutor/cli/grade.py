"""`ros-tutor grade`: check a whole class, and give points."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import FAULT, INTERRUPTED, PASSED
from tutor.errors import EngineError, UsageError
from tutor.invocation import command
from tutor.judge.wording import counted

if TYPE_CHECKING:
    from tutor.content import Course
    from tutor.grade.grading import Plan
    from tutor.grade.points import Points
    from tutor.grade.results import Result, ResultFolder
    from tutor.grade.submissions import Work

_FORMATS = ("text", "csv")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[SUBMISSIONS] [options]`."""
    parser.add_argument(
        "submissions",
        metavar="SUBMISSIONS",
        nargs="?",
        type=Path,
        help="a folder or zip, with one for each learner",
    )
    parser.add_argument(
        "--exercise", metavar="ID", action="append", help="only this one (repeatable; else all that were handed in)"
    )
    parser.add_argument(
        "--layout", metavar="PATTERN", default="", help="where learners are, such as '{learner}/{exercise}'"
    )
    parser.add_argument("--roster", metavar="FILE", type=Path, help="a CSV of folder, name, id and email")
    parser.add_argument("--points", metavar="FILE", type=Path, help="what criteria are worth (points.toml)")
    parser.add_argument("--output", metavar="RESULTS", type=Path, help="the folder of results (SUBMISSIONS-results)")
    parser.add_argument("--format", choices=_FORMATS, default="text", help="text (default) or csv")
    parser.add_argument("--jobs", metavar="N", type=int, help="checks at once (else as many as this machine can judge)")
    parser.add_argument("--limit", metavar="SECONDS", type=float, help="what is not judged by then is an error (300)")
    parser.add_argument("--again", action="store_true", help="check everything again")
    parser.add_argument("--no-isolation", action="store_true", help="run code that you have not read as yourself")
    parser.add_argument("--shard", metavar="K/N", help="only the Kth of N parts, for one of N machines")
    parser.add_argument("--collect", metavar="DIR", nargs="+", type=Path, help="merge results; check nothing")


def run(arguments: argparse.Namespace) -> int:
    """Grade, and write the report to stdout. Exit code 0: all is judged, whatever the verdicts; 3: not all is."""
    from tutor.grade.points import Points
    from tutor.grade.results import ResultFolder

    course = context.load_course(arguments)
    _check_options(arguments)
    points = Points.read(arguments.points, course) if arguments.points else Points()
    folder = ResultFolder(_output(arguments))
    if arguments.collect:
        results: Sequence[Result] | None = _collect(arguments.collect, folder)
    else:
        results = _grade(arguments, course, folder)
    if results is None:
        terminal.say(f"interrupted; what was judged is in {folder.root}, and the same command goes on from there")
        return INTERRUPTED
    return _report(results, arguments, course, points)


def _check_options(arguments: argparse.Namespace) -> None:
    if (arguments.submissions is None) == (arguments.collect is None):
        raise UsageError("name the SUBMISSIONS of the class, or the results to --collect")
    if arguments.submissions is not None and not arguments.submissions.exists():
        raise UsageError(f"there is no {arguments.submissions}")
    if arguments.jobs is not None and arguments.jobs < 1:
        raise UsageError(f"--jobs {arguments.jobs}: at least one")
    if arguments.limit is not None and not arguments.limit > 0:
        raise UsageError(f"--limit {arguments.limit}: a number of seconds above 0")
    _shard(arguments.shard)


def _output(arguments: argparse.Namespace) -> Path:
    output: Path | None = arguments.output
    if output is None:
        if arguments.collect:
            raise UsageError("--collect needs --output RESULTS")
        source = Path(arguments.submissions).absolute()
        output = source.with_name(f"{source.stem if source.is_file() else source.name}-results")
    if output.exists() and not output.is_dir():
        raise UsageError(f"--output {output}: this is a file, not a folder")
    return output


def _shard(text: str | None) -> tuple[int, int]:
    """Return which part of how many to check; `(1, 1)` is everything. Raises UsageError."""
    if text is None:
        return 1, 1
    part, _, parts = text.partition("/")
    if not (part.isdecimal() and parts.isdecimal() and 1 <= int(part) <= int(parts)):
        raise UsageError(f"--shard {text}: write it as 3/8, for the third of eight parts")
    return int(part), int(parts)


def _collect(folders: Sequence[Path], target: ResultFolder) -> list[Result]:
    """Copy the results of several folders into one: the latest of each, and a verdict rather than an error."""
    from tutor.grade.results import ResultFolder

    best: dict[tuple[str, str], Result] = {}
    for folder in (target.root, *folders):
        if folder != target.root and not folder.is_dir():
            raise UsageError(f"--collect {folder}: there is no such folder")
        for result in ResultFolder(folder):
            key = result.learner.id, result.exercise
            rank = (result.status != "error", result.graded_at)
            if key not in best or rank > (best[key].status != "error", best[key].graded_at):
                best[key] = result
    if not best:
        raise UsageError(f"there are no results in {', '.join(map(str, folders))}")
    for result in best.values():
        target.save(result)
    return list(best.values())


def _grade(arguments: argparse.Namespace, course: Course, folder: ResultFolder) -> list[Result] | None:
    """Check what has no current result; return all results, or None if this was interrupted."""
    from tutor import private_folders
    from tutor.grade.learners import Roster
    from tutor.grade.submissions import find_work

    roster = Roster.read(arguments.roster) if arguments.roster else None
    with private_folders.temporary("class") as scratch:
        works = find_work(
            arguments.submissions,
            course,
            scratch,
            exercises=arguments.exercise or (),
            layout=arguments.layout,
            roster=roster,
        )
        part, parts = _shard(arguments.shard)
        return _run(works[part - 1 :: parts], arguments, course, folder)


def _run(
    works: Sequence[Work], arguments: argparse.Namespace, course: Course, folder: ResultFolder
) -> list[Result] | None:
    from tutor.cli.grade_display import display_for
    from tutor.cli.judging import interruptible
    from tutor.grade.grading import Grading, LocalExecutor, Options
    from tutor.grade.machine import checks_at_once, cores, costs_from, estimate_s, words_for
    from tutor.grade.unit import DEFAULT_LIMIT_S

    folder.sweep()
    grading = Grading(course, folder)
    plan = grading.plan(works, again=arguments.again)
    options = Options(
        isolate=bool(plan.todo) and not arguments.no_isolation and _can_isolate(),
        limit_s=arguments.limit or DEFAULT_LIMIT_S,
        lessons=getattr(arguments, "lessons", None),
    )
    executor = LocalExecutor(arguments.jobs or checks_at_once())
    costs, available_cores = costs_from(folder), cores()
    seconds = estimate_s((work.exercise for work in plan.todo), costs, executor.slots, available_cores)
    _announce(plan, f"about {words_for(seconds)}, {counted(executor.slots, 'check')} at once")
    display = display_for(plan, executor.slots, costs, available_cores)
    return interruptible(lambda: grading.grade(plan, executor, options, display, costs), display)


def _announce(plan: Plan, estimate: str) -> None:
    keys = [(each.learner.id, each.exercise) for part in (plan.todo, plan.missing, plan.kept) for each in part]
    learners, exercises = counted(len({learner for learner, _ in keys}), "learner"), {exercise for _, exercise in keys}
    already = f", {len(plan.kept)} of them judged before" if plan.kept else ""
    missing = f", {len(plan.missing)} without files" if plan.missing else ""
    terminal.say(f"{learners}, {', '.join(sorted(exercises))}: {counted(len(keys), 'result')}{already}{missing}")
    if plan.todo:
        terminal.say(f"{counted(len(plan.todo), 'check')} to run: {estimate}")


def _can_isolate() -> bool:
    """Whether submissions can be isolated here; if not, ask whether to go on. Raises EngineError if it is not."""
    from tutor.grade.isolation import why_not_isolated

    problem = why_not_isolated()
    if problem is None:
        return True
    what = f"submissions cannot be isolated here: {problem}"
    if not (terminal.is_terminal(sys.stdin) and terminal.is_terminal(sys.stderr)):
        raise EngineError(what, f"{problem.hint}; or run code that you have not read as yourself, with --no-isolation")
    terminal.say(f"{what}. {problem.hint}")
    terminal.say("Without isolation they run as you: they can read and change your files, and use the network.")
    print("Go on without isolation? [y/N] ", end="", file=sys.stderr, flush=True)
    if sys.stdin.readline().strip().lower() not in ("y", "yes"):
        raise EngineError("nothing was checked", f"see `{command('doctor')}`")
    return False


# --- the report ---


def _report(results: Sequence[Result], arguments: argparse.Namespace, course: Course, points: Points) -> int:
    from tutor.grade.gradebook import Gradebook

    gradebook = Gradebook.of(results, course, points)
    if arguments.format == "csv":
        from tutor.grade.formats import csv_table

        terminal.out(csv_table.render(gradebook))
    else:
        from tutor.grade.formats import text

        color, width = terminal.wants_color(sys.stdout), terminal.width(sys.stdout)
        terminal.out(text.render(gradebook, color=color, width=width))
    for result in gradebook.errors:
        terminal.say(f"not judged: {result.learner.name}, {result.exercise}: {_fault_of(result)}")
    return FAULT if gradebook.errors else PASSED


def _fault_of(result: Result) -> str:
    from tutor.judge.verdict import Status

    judged = result.judged
    criteria = judged.criteria if judged is not None else ()
    causes = [criterion.verdict.cause for criterion in criteria if criterion.verdict.status is Status.ERROR]
    return causes[0] if causes else result.report.message
