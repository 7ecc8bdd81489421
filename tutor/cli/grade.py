"""`ros-tutor grade`: check a whole class, give points, and write what the systems around a class take."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tutor.cli import context, terminal
from tutor.cli.errors import FAULT, INTERRUPTED, PASSED
from tutor.errors import EngineError, UsageError
from tutor.invocation import command
from tutor.judge.wording import counted

if TYPE_CHECKING:
    from tutor.content import Course
    from tutor.grade.grading import Executor, Options, Plan
    from tutor.grade.points import Points
    from tutor.grade.results import Result, ResultFolder
    from tutor.grade.work import Work

_FORMATS = ("text", "csv", "json", "junit", "html", "canvas", "moodle", "gradescope", "classroom50", "check50")
_STEPS = ("none", "words")


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
    parser.add_argument("--format", choices=_FORMATS, default="text", help=f"{', '.join(_FORMATS)}")
    parser.add_argument("--gradebook", metavar="FILE", type=Path, help="for canvas, moodle: the CSV it exported")
    parser.add_argument("--steps", choices=_STEPS, default="words", help="tell learners no next step (none), or words")
    parser.add_argument("--jobs", metavar="N", type=int, help="checks at once (else as many as this machine can judge)")
    parser.add_argument("--limit", metavar="SECONDS", type=float, help="what is not judged by then is an error (300)")
    parser.add_argument("--again", action="store_true", help="check everything again")
    parser.add_argument("--no-isolation", action="store_true", help="run code that you have not read as yourself")
    parser.add_argument("--shard", metavar="K/N", help="only the Kth of N parts, for one of N machines")
    parser.add_argument("--collect", metavar="DIR", nargs="+", type=Path, help="merge results; check nothing")
    parser.add_argument("--executor", choices=("local", "dask"), default="local", help="where checks run")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="Dask's scheduler, such as tcp://10.0.0.1:8786")


def run(arguments: argparse.Namespace) -> int:
    """Grade, and write the report to stdout. Exit code 0: all is judged, whatever the verdicts; 3: not all is."""
    from tutor.grade.points import Points
    from tutor.grade.results import ResultFolder

    courses = context.choose_courses(arguments)
    course, lessons = context.load(courses), context.only_folder(courses)
    _check_options(arguments)
    points = Points.read(arguments.points, course) if arguments.points else Points()
    folder = ResultFolder(_output(arguments))
    if arguments.collect:
        results: Sequence[Result] | None = _collect(arguments.collect, folder)
    else:
        results = _grade(arguments, course, lessons, folder)
    if results is None:
        terminal.say(f"interrupted; what was judged is in {folder.root}, and the same command goes on from there")
        return INTERRUPTED
    return _report(results, arguments, course, points, folder)


def _check_options(arguments: argparse.Namespace) -> None:
    if (arguments.submissions is None) == (arguments.collect is None):
        raise UsageError("name the SUBMISSIONS of the class, or the results to --collect")
    if arguments.submissions is not None and not arguments.submissions.exists():
        raise UsageError(f"there is no {arguments.submissions}")
    if arguments.jobs is not None and arguments.jobs < 1:
        raise UsageError(f"--jobs {arguments.jobs}: at least one")
    if arguments.limit is not None and not arguments.limit > 0:
        raise UsageError(f"--limit {arguments.limit}: a number of seconds above 0")
    if arguments.scheduler and arguments.executor != "dask":
        raise UsageError("--scheduler needs --executor dask")
    if arguments.gradebook is not None and arguments.format not in ("canvas", "moodle"):
        raise UsageError("--gradebook is for --format canvas and moodle")
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
    if arguments.submissions is not None and output.resolve().is_relative_to(arguments.submissions.resolve()):
        raise UsageError(f"--output {output}: it is in {arguments.submissions}, and would be taken for a submission")
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


def _grade(
    arguments: argparse.Namespace, course: Course, lessons: Path | None, folder: ResultFolder
) -> list[Result] | None:
    """Check what has no current result; return all results, or None if this was interrupted.

    `lessons`: the folder of the teacher's own course.
    """
    from tutor import private_folders
    from tutor.grade.roster import Roster
    from tutor.grade.work import find_work

    roster = Roster.read(arguments.roster) if arguments.roster else None
    with private_folders.temporary("class") as scratch:
        works = find_work(
            arguments.submissions,
            course,
            scratch,
            exercises=arguments.exercise or (),
            layout=arguments.layout,
            roster=roster,
            note=terminal.say,
        )
        part, parts = _shard(arguments.shard)
        return _run(works[part - 1 :: parts], arguments, course, lessons, folder)


def _run(
    works: Sequence[Work],
    arguments: argparse.Namespace,
    course: Course,
    lessons: Path | None,
    folder: ResultFolder,
) -> list[Result] | None:
    from dataclasses import replace

    from tutor.cli.grade_display import display_for
    from tutor.cli.interruptible_run import interruptible
    from tutor.grade.capacity import costs_from, estimate_s, words_for
    from tutor.grade.grading import Grading, Options
    from tutor.grade.unit import DEFAULT_LIMIT_S

    folder.sweep()
    grading = Grading(course, folder)
    plan = grading.plan(works, again=arguments.again)
    options = Options(
        isolate=not arguments.no_isolation,
        limit_s=arguments.limit or DEFAULT_LIMIT_S,
        lessons=lessons,
    )
    with _open_place(arguments, plan, options) as place:
        if plan.todo and options.isolate:
            options = replace(options, isolate=_can_isolate(place.why_not_isolated()))
        costs, slots = costs_from(folder), place.executor.slots
        seconds = estimate_s((work.exercise for work in plan.todo), costs, slots, place.cores)
        _announce(plan, f"about {words_for(seconds)}, {counted(slots, 'check')} at once")
        display = display_for(plan, slots, costs, place.cores)
        return interruptible(lambda: grading.grade(plan, place.executor, options, display, costs), display)


def _announce(plan: Plan, estimate: str) -> None:
    keys = [(entry.learner.id, entry.exercise) for part in (plan.todo, plan.missing, plan.kept) for entry in part]
    learners, exercises = counted(len({learner for learner, _ in keys}), "learner"), {exercise for _, exercise in keys}
    already = f", {len(plan.kept)} of them judged before" if plan.kept else ""
    missing = f", {len(plan.missing)} without files" if plan.missing else ""
    terminal.say(f"{learners}, {', '.join(sorted(exercises))}: {counted(len(keys), 'result')}{already}{missing}")
    if plan.todo:
        terminal.say(f"{counted(len(plan.todo), 'check')} to run: {estimate}")


class _Place(NamedTuple):
    """Where checks run. `cores`: how many there are; `why_not_isolated`: what keeps submissions from being isolated."""

    executor: Executor
    cores: float
    why_not_isolated: Callable[[], EngineError | None]


@contextmanager
def _open_place(arguments: argparse.Namespace, plan: Plan, options: Options) -> Iterator[_Place]:
    from tutor.grade.capacity import checks_at_once, cores
    from tutor.grade.grading import LocalExecutor
    from tutor.process.isolation_support import try_isolation

    if arguments.executor == "local" or not plan.todo:
        yield _Place(LocalExecutor(arguments.jobs or checks_at_once()), cores(), try_isolation)
        return
    try:
        from tutor.grade.dask_executor import open_executor
    except ModuleNotFoundError as error:
        raise EngineError(f"--executor dask needs Dask ({error})", "install ros-tutor[cluster]") from error
    if not options.isolate:
        terminal.say("without isolation, a submission can reach Dask, and run what it likes on each worker and here")
    with open_executor(
        arguments.scheduler,
        arguments.jobs,
        checks_at_once(),
        options.lessons,
        isolate=options.isolate,
        live=terminal.can_animate(sys.stderr),
        say=terminal.say,
    ) as executor:
        yield _Place(executor, executor.cores, lambda: executor.not_isolated)


def _can_isolate(problem: EngineError | None) -> bool:
    """Whether submissions can be isolated; if not, ask whether to go on. Raises EngineError if the answer is no."""
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


def _report(
    results: Sequence[Result], arguments: argparse.Namespace, course: Course, points: Points, folder: ResultFolder
) -> int:
    from tutor.grade import formats
    from tutor.grade.formats.feedback_text import fault_of
    from tutor.grade.gradebook import Gradebook

    gradebook = Gradebook.of(results, course, points, steps=arguments.steps == "words", title=_title(arguments, folder))
    if arguments.format in formats.FILES:
        written = formats.write(gradebook, arguments.format, folder.root)
        terminal.out("".join(f"{context.display_path(path)}\n" for path in written))
    elif arguments.format in formats.DOCUMENTS:
        terminal.out(formats.render(gradebook, arguments.format, _read_template(arguments.gradebook)))
    else:
        from tutor.grade.formats import text

        color, width = terminal.wants_color(sys.stdout), terminal.width(sys.stdout)
        terminal.out(text.render(gradebook, color=color, width=width))
    for result in gradebook.errors:
        terminal.say(f"not judged: {result.learner.name}, {result.exercise}: {fault_of(result)}")
    return FAULT if gradebook.errors else PASSED


def _title(arguments: argparse.Namespace, folder: ResultFolder) -> str:
    source: Path | None = arguments.submissions
    if source is None:
        return folder.root.resolve().name.removesuffix("-results")
    return source.stem if source.is_file() else source.resolve().name


def _read_template(path: Path | None) -> str | None:
    if path is None:
        return None
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(
            f"--gradebook {path}: cannot be read: {getattr(error, 'strerror', 'it is not UTF-8')}"
        ) from error
