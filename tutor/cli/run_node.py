"""`ros-tutor run`: run the learner's node in the foreground, in the workspace's ROS domain."""

from __future__ import annotations

import argparse
import os
import sys
from typing import TYPE_CHECKING, NoReturn

from tutor.cli import context, terminal
from tutor.cli.interfaces import build_interfaces
from tutor.errors import UsageError
from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Lesson, LessonFile
    from tutor.session.node_command import NodeCommand


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [FILE] [--partner] [-- ARGUMENT...]`."""
    parser.usage = "%(prog)s EXERCISE [FILE] [options] [-- ARGUMENT ...]"
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i2.1; ends with Ctrl+C")
    parser.add_argument("file", metavar="FILE", nargs="?", help="which of its files (default: the first one)")
    parser.add_argument(
        "--partner",
        action="store_true",
        help="run our node that goes with yours instead: the given system, or what yours talks to",
    )
    parser.epilog = (
        "Arguments after -- go to the node: -- --ros-args -p publish_rate:=2.0 (for a launch file: -- topic:=my_topic)"
    )
    parser.set_defaults(rest=[])


def run(arguments: argparse.Namespace) -> int:
    """Exec the node; does not return. Raises UsageError if it cannot be started."""
    from tutor.errors import CommandError
    from tutor.session import Session
    from tutor.workspace import RunOptions

    course = context.load_course(arguments)
    lesson = course.find(arguments.exercise)
    file = _choose_file(lesson, arguments.file)
    session = Session(course, context.require_workspace(arguments))
    if arguments.partner:
        partner = lesson.live.partner_of(file.name)
        if partner is None:
            raise UsageError(f"{lesson.id} has no partner: no node of ours goes with {file.name}")
        try:
            node = session.partner_command(partner)
        except CommandError as error:
            raise UsageError(str(error)) from error
        terminal.say(f"{partner.name} in ROS domain {session.domain}: {partner.does}; Ctrl+C ends it")
        _exec(node, arguments.rest)
    path = session.path(file)
    if not path.is_file():
        raise UsageError(f"{path} does not exist; `{command('start', lesson.id)}` puts the skeleton there")
    build_interfaces(session.workspace)
    try:
        node = session.node_command(file, RunOptions())
    except CommandError as error:
        raise UsageError(str(error)) from error
    terminal.say(f"{context.display_path(path)} in ROS domain {session.domain}; Ctrl+C ends it")
    _exec(node, arguments.rest)


def _exec(node: NodeCommand, rest: list[str]) -> NoReturn:
    sys.stdout.flush()
    os.chdir(node.cwd)
    os.execve(node.argv[0], [*node.argv, *rest], node.env)


def _choose_file(lesson: Lesson, name: str | None) -> LessonFile:
    names = {alias: file for file in lesson.files for alias in (file.name, file.name.removesuffix(".py"))}
    if name is None:
        return lesson.files[0]
    if name not in names:
        known = " and ".join(file.name for file in lesson.files)
        raise UsageError(f"{lesson.id} has no file {name!r}; it has {known}. Put the node's own arguments after --")
    return names[name]
