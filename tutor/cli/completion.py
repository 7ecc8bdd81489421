"""`ros-tutor completion`: Tab completion for bash, zsh and fish, by argcomplete.

The shell asks the program itself, so that exercises of `--lessons` and the criteria of the exercise that was typed are
known.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.cli.grammar import command_parsers
from tutor.invocation import PROGRAM, command, program

if TYPE_CHECKING:
    from tutor.content import Course

ASKED = "_ARGCOMPLETE"
"""The variable by which a shell asks for completions, in place of running the command."""

SHELLS = {
    "bash": '~/.bashrc:                   eval "$({})"',
    "zsh": '~/.zshrc, after compinit:    eval "$({})"',
    "fish": "~/.config/fish/config.fish:  {} | source",
}
"""Where the line goes that switches it on, and the line."""

Completer = Callable[..., Iterable[str]]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """SHELL."""
    parser.add_argument("shell", metavar="SHELL", choices=tuple(SHELLS), help=f"{', '.join(SHELLS)}")
    lines = (line.format(command("completion", shell)) for shell, line in SHELLS.items())
    parser.epilog = "To switch it on, add a line to\n" + "".join(f"  {line}\n" for line in lines)


def run(arguments: argparse.Namespace) -> int:
    """Print the lines that make Tab ask us."""
    from argcomplete.shell_integration import shellcode

    # bash and zsh look for the name of the file, wherever it is; fish for a path where it is one.
    names = [PROGRAM]
    if arguments.shell == "fish" and "/" in program():
        names = [os.path.abspath(program().strip("'"))]
    terminal.out(shellcode(names, shell=arguments.shell))
    return PASSED


def is_asked() -> bool:
    """Whether the shell wants completions."""
    return ASKED in os.environ


def answer(build: Callable[..., argparse.ArgumentParser]) -> None:
    """Give the shell its completions, and end the process. `build` makes the parser of the whole command line."""
    import argcomplete

    from tutor.cli import ros2

    if (rest := _after_ros2(os.environ.get("COMP_LINE", ""))) is not None:
        left_out = len(os.environ["COMP_LINE"]) - len(rest)
        os.environ["COMP_POINT"] = str(int(os.environ["COMP_POINT"]) - left_out)
        os.environ["COMP_LINE"] = rest
        ros2.run(argparse.Namespace(words=[]))  # becomes ros2, which knows its verbs
    parser = build(mixing=False)
    parsers = command_parsers(parser)
    for name, each in parsers.items():
        for action in each._actions:
            if (completer := _completer(name, action, list(parsers))) is not None:
                action.completer = completer  # type: ignore[attr-defined]  # where argcomplete looks for it
    argcomplete.autocomplete(parser, exclude=["-h", "--help", "--version"])


def _after_ros2(line: str) -> str | None:
    """What follows the program's name where that is `ros2 ` and more."""
    rest = line.lstrip().partition(" ")[2].lstrip()
    return rest if rest.startswith("ros2 ") else None


def _completer(name: str, action: argparse.Action, commands: list[str]) -> Completer | None:
    from argcomplete.completers import DirectoriesCompleter

    def of_course(choose: Callable[[Course, argparse.Namespace], Iterable[str]]) -> Completer:
        def complete(parsed_args: argparse.Namespace, **_: Any) -> Iterable[str]:
            return choose(context.load_course(parsed_args), parsed_args)

        return complete

    match action.metavar:
        case "DIR":
            directories: Completer = DirectoriesCompleter()
            return directories
        case "EXERCISE":
            more = ("all",) if name == "check" else ()
            return of_course(lambda course, _: [*(lesson.id for lesson in course.lessons), *more])
        case "ID" if "--criterion" in action.option_strings:
            return of_course(_criteria)
        case "ITEM":
            return of_course(lambda course, _: [item.id for item in course.checklist.items])
        case "FILE" if name == "run":
            return of_course(lambda course, given: [Path(file.name).stem for file in course.find(given.exercise).files])
        case "COMMAND" if name == "help":
            return lambda **_: commands
    return None


def _criteria(course: Course, given: argparse.Namespace) -> list[str]:
    """Those of the exercise that was typed, else all."""
    exercise = getattr(given, "exercise", None)
    lessons = [course.find(exercise)] if exercise and course.knows(exercise) else course.lessons
    return list(dict.fromkeys(criterion.id for lesson in lessons for criterion in lesson.criteria))
