"""`ros-tutor predict`: say what a given program will do, then see what it does."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import FAULT, INTERRUPTED, NOT_PASSED, PASSED
from tutor.errors import UsageError
from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Lesson, Prediction
    from tutor.session.node import NodeState
    from tutor.workspace import Progress


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[EXERCISE [ID]] [--answer N]`."""
    parser.add_argument("exercise", metavar="EXERCISE", nargs="?", help="for example i2.3; without it, all are listed")
    parser.add_argument("prediction", metavar="ID", nargs="?", help="the prediction to answer, by its id or number")
    parser.add_argument("--answer", metavar="N", type=int, help="the number of your answer, instead of asking for it")


def run(arguments: argparse.Namespace) -> int:
    """List the predictions; or show one, ask for an answer, run its program, and say whether it was right."""
    course = context.load_course(arguments)
    lessons = [lesson for lesson in course.lessons if lesson.predictions]
    if arguments.exercise is not None:
        lessons = [_with_predictions(course.find(arguments.exercise), lessons)]
    if arguments.prediction is not None:
        return _predict(arguments, lessons[0], _find(arguments.prediction, lessons[0]))
    if arguments.answer is not None:
        raise UsageError("--answer needs EXERCISE and ID: which prediction does it answer?")
    progress = context.read_progress(context.require_workspace(arguments))
    terminal.out("\n".join(_list(lessons, progress)) + "\n")
    return PASSED


def _with_predictions(lesson: Lesson, lessons: list[Lesson]) -> Lesson:
    if not lesson.predictions:
        others = f"; {' and '.join(other.id for other in lessons)} have some" if lessons else ""
        raise UsageError(f"{lesson.id} has nothing to predict{others}")
    return lesson


def _find(name: str, lesson: Lesson) -> Prediction:
    known = {prediction.id: prediction for prediction in lesson.predictions}
    numbered = {str(number): prediction for number, prediction in enumerate(lesson.predictions, 1)}
    if name.lower() not in known | numbered:
        raise UsageError(f"{lesson.id} has no prediction {name!r}; it has {', '.join(known)}")
    return (known | numbered)[name.lower()]


def _list(lessons: list[Lesson], progress: Progress) -> Iterator[str]:
    from tutor.session.predictions import standing

    for lesson in lessons:
        answers = progress.of(lesson.id).predictions
        width = max(len(prediction.id) for prediction in lesson.predictions)
        yield terminal.style(f"{lesson.id} {lesson.title}", "1", sys.stdout)
        for number, prediction in enumerate(lesson.predictions, 1):
            yield f"  {number}  {prediction.id:{width}}  {standing(answers.get(prediction.id))}"
        yield ""
    if lessons:
        open_ones = [
            (lesson.id, prediction.id)
            for lesson in lessons
            for prediction in lesson.predictions
            if not ((answer := progress.of(lesson.id).predictions.get(prediction.id)) and answer.right)
        ]
        yield f"To answer one: {command('predict', *(open_ones or [(lessons[0].id, lessons[0].predictions[0].id)])[0])}"
    else:
        yield "There is nothing to predict in this course."


def _predict(arguments: argparse.Namespace, lesson: Lesson, prediction: Prediction) -> int:
    from tutor.session import Session
    from tutor.session.predictions import run_prediction
    from tutor.stop_signals import Stopped, run_until_stopped

    session = Session(context.load_course(arguments), context.require_workspace(arguments))
    session.notify = terminal.say
    terminal.out(_question(prediction))
    answer = _ask(prediction, arguments.answer)
    try:
        outcome = run_until_stopped(lambda: run_prediction(prediction, _Output().show))
    except Stopped:
        terminal.say("interrupted; nothing is left running, and nothing is recorded")
        return INTERRUPTED
    if outcome.holds is None:
        terminal.say(f"nothing is recorded, as {outcome.problem}. Is the machine very busy? Try again.")
        return FAULT
    terminal.out(_verdict(prediction, answer, outcome.holds))
    if session.workspace.exists:
        session.predict(lesson, prediction, answer == outcome.holds)
    else:
        terminal.say(f"without a workspace, your answer is not kept; `{command('start', lesson.id)}` makes one")
    return PASSED if answer == outcome.holds else NOT_PASSED


def _question(prediction: Prediction) -> str:
    columns = terminal.width(sys.stdout)
    program = prediction.program.read_text(encoding="utf-8")
    lines = [terminal.style(prediction.program.name, "1", sys.stdout), ""]
    lines += [f"    {line}".rstrip() for line in program.splitlines()]
    lines += ["", terminal.wrap(prediction.asks, columns)]
    lines += [f"  {number}  {option.says}" for number, option in enumerate(prediction.options, 1)]
    return "\n".join(lines) + "\n\n"


def _ask(prediction: Prediction, given: int | None) -> int:
    """Return the index of the learner's answer. Raises UsageError."""
    count = len(prediction.options)
    if given is not None:
        if not 1 <= given <= count:
            raise UsageError(f"--answer {given}: the answers go from 1 to {count}")
        return given - 1
    while True:
        terminal.out(f"Your answer, 1 to {count}: ")
        line = sys.stdin.readline() if sys.stdin is not None else ""
        if not terminal.is_terminal(sys.stdin):
            terminal.out("\n")
        if not line:
            raise UsageError("there was no answer, so nothing was run; --answer N gives one without being asked")
        if line.strip().isdecimal() and 1 <= int(line) <= count:
            return int(line) - 1


class _Output:
    """Writes what a program writes, as it comes."""

    def __init__(self) -> None:
        self._shown = 0

    def show(self, state: NodeState) -> None:
        """Write the lines that have come since."""
        for line in state.lines[self._shown :]:
            terminal.out(f"  | {line.text}\n")
        self._shown = len(state.lines)


def _verdict(prediction: Prediction, answer: int, seen: int) -> str:
    head = terminal.style("Right", "32", sys.stdout) if seen == answer else terminal.style("Not so", "31", sys.stdout)
    why = terminal.wrap(prediction.because, terminal.width(sys.stdout))
    return f"\n{head}. What was seen: {prediction.options[seen].says} ({seen + 1}).\n\n{why}"
