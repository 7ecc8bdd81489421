"""`ros-tutor start`: put an exercise's skeleton into the workspace."""

from __future__ import annotations

import argparse
from pathlib import Path

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.errors import UsageError
from tutor.invocation import command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [DIR] [--force] [--another]`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i1.1")
    parser.add_argument(
        "folder", metavar="DIR", nargs="?", help="put just the files there, instead of into the workspace"
    )
    parser.add_argument(
        "--force", action="store_true", help="replace existing files; each is kept beside the new one, as name.~1~"
    )
    parser.add_argument(
        "--another", action="store_true", help="hand over another fault, where an exercise has several (b1.7)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Put the files in place and say where they are."""
    from tutor.content.cases import cases_of
    from tutor.workspace import start, start_another, start_in

    courses = context.choose_courses(arguments)
    course = context.load(courses)
    lesson = course.find(arguments.exercise)
    if arguments.another and (cases_of(lesson) is None or arguments.folder is not None):
        why = "there is only one of it" if arguments.folder is None else "what is drawn is known to the workspace only"
        raise UsageError(f"--another is not for {lesson.id} {arguments.folder or ''}".rstrip() + f": {why}")
    found = ""
    if arguments.folder is None:
        workspace = context.choose_workspace(arguments)
        started = (
            start_another(lesson, workspace) if arguments.another else start(lesson, workspace, force=arguments.force)
        )
        found = workspace.cases(terminal.say).read(lesson.id).describe()
        workspace.courses(terminal.say).add(courses)
        if started.created_workspace:
            terminal.out(f"Created your workspace: {workspace.root}\n")
        read, check = command("lesson", lesson.id), command("check", lesson.id)
    else:
        if course.knows(arguments.folder):
            raise UsageError(
                f"start takes one exercise at a time: `{command('start', arguments.folder)}` starts the other one "
                f"(a folder of that name is ./{arguments.folder})"
            )
        started = start_in(lesson, Path(arguments.folder), force=arguments.force)
        named = [word for given in getattr(arguments, "lessons", ()) for word in ("--lessons", given)]
        read, check = command("lesson", lesson.id, *named), command("check", lesson.id, arguments.folder, *named)

    lines = [f"{lesson.id} {lesson.title} ({lesson.difficulty.value}): {lesson.objective.strip()}"]
    lines += [f"  to read        {read}"]
    lines += [f"  to edit        {context.display_path(path)}" for path in started.files.written]
    lines += [f"  already there  {context.display_path(path)}" for path in started.files.already_there]
    lines += [f"  kept           {context.display_path(path)}" for path in started.files.backups]
    lines += [f"  so far         {found}"] if found else []
    lines += [f"Then: {check}"]
    terminal.out("\n".join(lines) + "\n")
    return PASSED
