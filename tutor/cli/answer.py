"""`ros-tutor answer`: say what is wrong with the system that an exercise has handed over, and where."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.errors import UsageError
from tutor.invocation import command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE [WHAT WHERE]`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example b1.7")
    parser.add_argument("what", metavar="WHAT", nargs="?", help="what is wrong (without it: the choices)")
    parser.add_argument("where", metavar="WHERE", nargs="?", help="the file that it is in")


def run(arguments: argparse.Namespace) -> int:
    """Write the answer given, or ask for it; where nobody can be asked, print the choices."""
    from tutor.workspace.answering import answer, ask

    lesson = context.load_course(arguments).find(arguments.exercise)
    workspace = context.require_workspace(arguments)
    question = ask(lesson, workspace)
    kinds, places = question.cases.kinds, dict.fromkeys(question.cases.places, "")
    what, where = arguments.what or "", arguments.where or ""
    if not what or not where:
        if not terminal.is_terminal(sys.stdin):
            if what:
                raise UsageError(f"say where, too: {command('answer', lesson.id, what, 'FILE')}")
            terminal.out("\n".join(_choices("What is wrong?", kinds)) + "\n")
            terminal.out("\n".join(_choices("In which file?", places)) + "\n")
            terminal.out(f"Then: {command('answer', lesson.id)} WHAT WHERE\n")
            return PASSED
        what = what or _choose("What is wrong?", kinds)
        where = where or _choose("In which file?", places)
    report = answer(lesson, workspace, _named(what, kinds), _named(where, places))
    lines = [f"{kinds[report.what]}, in {report.where}", f"  reported in {context.display_path(question.path)}"]
    terminal.out("\n".join([*lines, f"Then: {command('check', lesson.id)}"]) + "\n")
    return PASSED


def _choices(title: str, choices: Mapping[str, str]) -> list[str]:
    width = max(map(len, choices))
    lines = [f"{number:3}  {id:{width}}  {says}".rstrip() for number, (id, says) in enumerate(choices.items(), 1)]
    return [terminal.style(title, "1", sys.stdout), *lines]


def _choose(title: str, choices: Mapping[str, str]) -> str:
    """Ask for one of the choices, by its number or name. Raises UsageError at the end of the input."""
    terminal.out("\n".join(_choices(title, choices)) + "\n")
    while True:
        sys.stderr.write(f"1 to {len(choices)}, or the word: ")
        sys.stderr.flush()
        line = sys.stdin.readline()
        if not line:
            raise UsageError("nothing was chosen, and nothing is reported")
        chosen = _named(line.strip(), choices)
        if chosen in choices:
            return chosen


def _named(word: str, choices: Mapping[str, str]) -> str:
    """The choice with this number in the list, if the word is one, else the word itself."""
    if word not in choices and word.isdecimal() and 1 <= int(word) <= len(choices):
        return list(choices)[int(word) - 1]
    return word
