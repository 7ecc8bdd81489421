"""`ros-tutor author`: make, verify and pack a course, for course authors."""

from __future__ import annotations

import argparse
from pathlib import Path

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.errors import UsageError
from tutor.invocation import command

_ACTIONS = ("new", "check", "pack")
_EPILOG = """\
author new x1.1 "Street Lamp" [--course DIR]   write an exercise that works, for you to change
author check [EXERCISE ...] [--watch]          prove it: what must fail fails, what must pass passes
author pack [DIR] [--output FILE]              make one file of the course, for --lessons FILE
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `new EXERCISE TITLE [--course DIR]`, `check [EXERCISE...] [...]` and `pack [DIR] [--output FILE]`."""
    parser.epilog = _EPILOG
    parser.add_argument("action", metavar="ACTION", choices=_ACTIONS, help="new, check or pack")
    parser.add_argument(
        "exercises",
        metavar="EXERCISE",
        nargs="*",
        help="check: only these, or only this submission: x1.1/wrong/NAME (else the whole course, which --lessons "
        "names, or the current folder is, or comes with ros-tutor)",
    )
    parser.add_argument("--static", action="store_true", help="check: only read; run nothing")
    parser.add_argument("--watch", action="store_true", help="check: prove again what you change")
    parser.add_argument(
        "--submissions", metavar="DIR", type=Path, help="check: the test submissions (else submissions/ in the course)"
    )
    parser.add_argument("--course", metavar="DIR", type=Path, help="new: the folder of the course (else this one)")
    parser.add_argument("--output", metavar="FILE", type=Path, help="pack: the file to write (else NAME.course.zip)")


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action."""
    if arguments.action == "new":
        return _new(arguments)
    if arguments.action == "pack":
        return _pack(arguments)
    from tutor.cli import author_check, author_watch

    if arguments.watch and arguments.static:
        raise UsageError("--watch runs what you change; --static runs nothing")
    return author_watch.run(arguments) if arguments.watch else author_check.run(arguments)


def _new(arguments: argparse.Namespace) -> int:
    from tutor.content.exercise_template import new_exercise

    if len(arguments.exercises) != 2:
        raise UsageError(f"say which exercise, and its title: {command('author', 'new', 'x1.1', 'Street Lamp')}")
    exercise, title = arguments.exercises
    course: Path = arguments.course or Path()
    for path in new_exercise(exercise, title, course):
        terminal.out(f"  {context.display_path(path)}\n")
    words: list[str | Path] = [] if course.resolve() == Path.cwd() else ["--lessons", course]
    terminal.out(f"It works as it stands; see that with: {command('author', 'check', exercise, *words)}\n")
    return PASSED


def _pack(arguments: argparse.Namespace) -> int:
    from tutor.content import load_course
    from tutor.content.courses import MANIFEST, find_course, read_manifest
    from tutor.content.packing import SUFFIX, pack

    if len(arguments.exercises) > 1:
        raise UsageError("pack takes one course: name its folder")
    folder = find_course(arguments.exercises[0] if arguments.exercises else ".")
    manifest = read_manifest(folder)
    if not manifest.stated:
        raise UsageError(f"there is no {folder / MANIFEST}, which says `format: 1` and the `name` of the course")
    load_course(folder)  # a broken course is reported to its author
    file: Path = arguments.output or Path(f"{manifest.name}{SUFFIX}")
    if not file.name.endswith(SUFFIX):
        raise UsageError(f"--output {file}: the name of a packed course ends in {SUFFIX}")
    count = pack(folder, file)
    terminal.out(f"{context.display_path(file)}: {count} files. Use it with: {command('--lessons', file)}\n")
    return PASSED
