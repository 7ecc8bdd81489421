"""The parser of the whole command line: all commands and their arguments."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence

from tutor.cli import (
    answer,
    author,
    autograder,
    check,
    checklist,
    completion,
    diff,
    doctor,
    explain,
    grade,
    help_command,
    hint,
    lesson,
    list_exercises,
    next_exercise,
    predict,
    reset,
    ros2,
    run_node,
    serve,
    shell,
    solution,
    start,
    watch,
)
from tutor.cli.global_options import shared_options
from tutor.cli.grammar import CommandParser, Parser, read
from tutor.invocation import program

RunCommand = Callable[[argparse.Namespace], int]


_EPILOG = """\
Without a command, the terminal app opens.

exit codes: 0 passed, 1 not everything passed, 2 wrong usage, 3 a fault of the tool or the machine, 130 interrupted
"""


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line; `command` is None if none was given. Raises UsageError."""
    return read(build(), argv)


def build(*, mixing: bool = True) -> argparse.ArgumentParser:
    """Build the parser of the whole command line. `mixing`: allow options between a command's positional arguments."""
    shared = shared_options()
    parser = Parser(
        prog=program(),
        description="Hands-on ROS 2 exercises, judged by what your node really does.",
        epilog=_EPILOG,
        parents=[shared],
    )
    parser.set_defaults(command=None, parser=parser)
    parser.add_argument(
        "--plain", action="store_true", help="plain lines of text instead of the app, for screen readers"
    )
    commands = parser.add_subparsers(
        title="commands", metavar="COMMAND", parser_class=CommandParser if mixing else Parser
    )

    def add(name: str, run: RunCommand, arguments: Callable[[argparse.ArgumentParser], None], help: str) -> None:
        command = commands.add_parser(name, help=help, description=_as_sentence(help), parents=[shared])
        arguments(command)
        command.set_defaults(command=name, run=run)

    add("list", list_exercises.run, list_exercises.add_arguments, "show the exercises, with your progress")
    add("lesson", lesson.run, lesson.add_arguments, "read an exercise: what to do, and how")
    add("start", start.run, start.add_arguments, "put the skeleton of an exercise into the workspace")
    add("next", next_exercise.run, next_exercise.add_arguments, "show the first exercise not passed, and what to do")
    add("check", check.run, check.add_arguments, "judge an exercise by what your node does")
    add("watch", watch.run, watch.add_arguments, "check again at each save, until Ctrl+C")
    add("run", run_node.run, run_node.add_arguments, "run your node in this terminal, until Ctrl+C")
    add("diff", diff.run, diff.add_arguments, "compare your file with the skeleton, or with our solution")
    add("reset", reset.run, reset.add_arguments, "put the skeleton back; your file is kept beside it")
    add("hint", hint.run, hint.add_arguments, "show the next hint for an exercise")
    add("answer", answer.run, answer.add_arguments, "say what is wrong with a system that was handed over, and where")
    add("predict", predict.run, predict.add_arguments, "say what a given program will do, then see what it does")
    add("explain", explain.run, explain.add_arguments, "explain a mistake that a report names, or list all")
    add("solution", solution.run, solution.add_arguments, "print our solution of an exercise")
    add("checklist", checklist.run, checklist.add_arguments, "show, tick or export the self-assessment checklist")
    add("serve", serve.run, serve.add_arguments, "open the app in a browser, on this machine only")
    add("shell", shell.run, shell.add_arguments, "a shell in which ros2 works and your workspace is sourced")
    add("ros2", ros2.run, ros2.add_arguments, "the ros2 command, even without ROS 2 installed")
    add("completion", completion.run, completion.add_arguments, "print the Tab completion script for bash, zsh or fish")
    add("doctor", doctor.run, doctor.add_arguments, "say which ROS is used, and what is wrong with the machine")
    add("help", help_command.run, help_command.add_arguments, "show the help for a command, or all commands")
    add("grade", grade.run, grade.add_arguments, "check a whole class, with points, for teachers")
    add("autograder", autograder.run, autograder.add_arguments, "make what Gradescope or Classroom 50 runs")
    add("author", author.run, author.add_arguments, "verify a course, for course authors")
    return parser


def _as_sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."
