"""`ros-tutor completion`: Tab completion for bash, zsh and fish, through argcomplete.

The shell runs the program itself to complete a line, so the exercises of `--lessons` and the criteria of the exercise
already typed are known.
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

REQUEST_VARIABLE = "_ARGCOMPLETE"
"""The environment variable with which a shell requests completions instead of running the command."""

SHELLS = {
    "bash": '~/.bashrc:                   eval "$({})"',
    "zsh": '~/.zshrc, after compinit:    eval "$({})"',
    "fish": "~/.config/fish/config.fish:  {} | source",
}
"""For each shell, the startup file and the line to add to it, to enable completion; {} is the command."""

Completer = Callable[..., Iterable[str]]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `SHELL`."""
    parser.add_argument("shell", metavar="SHELL", choices=tuple(SHELLS), help=f"{', '.join(SHELLS)}")
    lines = (line.format(command("completion", shell)) for shell, line in SHELLS.items())
    parser.epilog = "To switch it on, add a line to\n" + "".join(f"  {line}\n" for line in lines)


def run(arguments: argparse.Namespace) -> int:
    """Print the shell code that enables completion."""
    from argcomplete.shell_integration import shellcode

    # bash and zsh match a command by its file name, wherever it is; fish needs the path if it was started by path.
    names = [PROGRAM]
    if arguments.shell == "fish" and "/" in program():
        names = [os.path.abspath(program().strip("'"))]
    terminal.out(shellcode(names, shell=arguments.shell))
    return PASSED


def is_requested() -> bool:
    """Whether the shell requests completions."""
    return REQUEST_VARIABLE in os.environ


def answer(build: Callable[..., argparse.ArgumentParser]) -> None:
    """Print completions for the shell and exit. `build` makes the parser of the whole command line."""
    import argcomplete

    from tutor.cli import ros2

    if (rest := _ros2_command_line(os.environ.get("COMP_LINE", ""))) is not None:
        removed = len(os.environ["COMP_LINE"]) - len(rest)
        os.environ["COMP_POINT"] = str(int(os.environ["COMP_POINT"]) - removed)
        os.environ["COMP_LINE"] = rest
        ros2.run(argparse.Namespace(words=[]))  # execs ros2, which completes its own verbs
    parser = build(mixing=False)
    parsers = command_parsers(parser)
    for name, subparser in parsers.items():
        for action in subparser._actions:
            if (completer := _make_completer(name, action, list(parsers))) is not None:
                action.completer = completer  # type: ignore[attr-defined]  # the attribute argcomplete reads
    argcomplete.autocomplete(parser, exclude=["-h", "--help", "--version"])


def _ros2_command_line(line: str) -> str | None:
    """Return the line without the program's name if `ros2 ` follows it; else None."""
    rest = line.lstrip().partition(" ")[2].lstrip()
    return rest if rest.startswith("ros2 ") else None


def _make_completer(name: str, action: argparse.Action, commands: list[str]) -> Completer | None:
    from argcomplete.completers import DirectoriesCompleter, FilesCompleter

    def complete_from_course(choose: Callable[[Course, argparse.Namespace], Iterable[str]]) -> Completer:
        def complete(parsed_args: argparse.Namespace, **_: Any) -> Iterable[str]:
            return choose(context.load_course(parsed_args), parsed_args)

        return complete

    match action.metavar:
        case "DIR":
            directories: Completer = DirectoriesCompleter()
            return directories
        case "COURSE":
            files: Completer = FilesCompleter()
            return files
        case "EXERCISE" if name == "predict":
            return complete_from_course(
                lambda course, _: [lesson.id for lesson in course.lessons if lesson.predictions]
            )
        case "EXERCISE":
            more = ("all",) if name == "check" else ()
            return complete_from_course(lambda course, _: [*(lesson.id for lesson in course.lessons), *more])
        case "ID" if "--criterion" in action.option_strings:
            return complete_from_course(_criterion_ids)
        case "ID" if name == "predict":
            return complete_from_course(_prediction_ids)
        case "ITEM":
            return complete_from_course(lambda course, _: [item.id for item in course.checklist.items])
        case "MISTAKE":
            return complete_from_course(_mistakes)
        case "FILE" if name == "run":
            return complete_from_course(
                lambda course, given: [Path(file.name).stem for file in course.find(given.exercise).files]
            )
        case "COMMAND" if name == "help":
            return lambda **_: commands
    return None


def _mistakes(course: Course, given: argparse.Namespace) -> dict[str, str]:
    """Return the ids of all mistakes, with what zsh and fish show beside them; none after the first word."""
    from tutor.engine.loading import load_catalogues
    from tutor.mistakes import pages

    if given.words:
        return {}
    return {id: entry.summary for id, entry in pages.every_mistake(load_catalogues(course)).items()}


def _prediction_ids(course: Course, given: argparse.Namespace) -> list[str]:
    """Return the predictions of the exercise already typed; none before."""
    known = given.exercise is not None and course.knows(given.exercise)
    return [prediction.id for prediction in course.find(given.exercise).predictions] if known else []


def _criterion_ids(course: Course, given: argparse.Namespace) -> list[str]:
    """Return the criteria of the exercise already typed, or else those of all exercises."""
    exercise = getattr(given, "exercise", None)
    lessons = [course.find(exercise)] if exercise and course.knows(exercise) else course.lessons
    return list(dict.fromkeys(criterion.id for lesson in lessons for criterion in lesson.criteria))
