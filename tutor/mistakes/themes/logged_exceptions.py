"""Exceptions that the learner's own code catches, and of which it logs or prints only the message."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame, Traceback
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.exceptions import EXPLAINED_WHILE_RUNNING, recognise_any
from tutor.mistakes.raised_exceptions import RaisedException, exceptions_of
from tutor.source import last_name

type _Expression = type[ast.Attribute | ast.Name | ast.Constant]

_MISTAKES: tuple[tuple[str, re.Pattern[str], _Expression], ...] = (
    ("AttributeError", re.compile(r"\S+ (?:object )?'?[\w.]*'? ?has no attribute '(?P<name>\w+)'.*"), ast.Attribute),
    ("NameError", re.compile(r"name '(?P<name>\w+)' is not defined.*"), ast.Name),
    ("UnboundLocalError", re.compile(r"cannot access local variable '(?P<name>\w+)'.*"), ast.Name),
    (
        "rclpy.exceptions.ParameterNotDeclaredException",
        re.compile(r"Invalid access to undeclared parameter\(s\): (?P<name>[\w.]+)"),
        ast.Constant,
    ),
)
"""Exceptions that are always mistakes: type, message, and the kind of expression that the name in it stands for."""

_BROAD = ("Exception", "BaseException", *(kind.rpartition(".")[2] for kind, _, _ in _MISTAKES))


@mistake(
    "exception-only-logged",
    explains=EXPLAINED_WHILE_RUNNING,
    evidence=Evidence.PROCESS,
    says="{raised}{what}, and an except of your own catches it",
    do="{step}",
    example=in_run(Symptom.NO_MESSAGES, logs=["failed: 'Bell' object has no attribute 'tunee'"]),
)
def only_logged(case: Case) -> Iterator[Found]:
    """A mistake is caught, and only its message is logged.

    A broad `except Exception` also catches mistakes in the program itself: a misspelled name, an attribute that is not
    there. The program goes on without having done its work, and only the last line of the traceback is left.

    Bad:

        try:
            self.play(self.tunee)
        except Exception as error:
            self.get_logger().error(f'failed: {error}')

    Good:

        try:
            self.play(self.tune)
        except OSError as error:
            self.get_logger().error(f'no sound: {error}')

    See it: the log of the node; leave the except out once, for the whole traceback.
    """
    if not any(_catches_mistakes(node) for node in case.program.nodes()):
        return
    for text in reversed([*(line.text for line in case.trace.output), *(log.text for log in case.trace.logs)]):
        for kind, message, expression in _MISTAKES:
            if (logged := message.search(text)) and (lines := _lines_with(case, expression, logged["name"])):
                raised = Traceback(kind, logged[0], (lines[0],))
                yield _told(exceptions_of(raised, case.program, case.trace.folder)[0], lines[0])


def _told(seen: RaisedException, frame: Frame) -> Found:
    known = recognise_any(seen)
    what = f": {known.words['says']}" if known is not None else ""
    step = known.words["do"] if known is not None else f"Correct line {frame.line}, and catch only what you expect."
    raised = f"{seen.raised} ({frame.name}, line {frame.line}: {frame.code})"
    return Found({"raised": raised, "what": what, "step": step}, frame.name, frame.line, frame.code)


def _catches_mistakes(node: ast.AST) -> bool:
    if not isinstance(node, ast.ExceptHandler):
        return False
    return node.type is None or any(last_name(caught) in _BROAD for caught in ast.walk(node.type))


def _lines_with(case: Case, expression: _Expression, name: str) -> list[Frame]:
    """The learner's lines in which an expression of this kind has this name, those that assign to it first.

    A parameter's name is only looked for where it is read.
    """

    def find() -> Iterator[tuple[bool, Frame]]:
        for file in case.files:
            read = [node for call in file.calls("get_parameter", "get_parameters") for node in ast.walk(call)]
            for node in file.nodes:
                if not isinstance(node, expression) or _name(node) != name:
                    continue
                if isinstance(node, ast.Constant) and node not in read:
                    continue
                reads = isinstance(node, ast.Constant) or isinstance(node.ctx, ast.Load)
                path = f"{case.trace.folder}/{file.name}"
                yield reads, Frame(path, node.lineno, "", file.line(node.lineno))

    return [frame for _, frame in sorted(find(), key=lambda place: (place[0], place[1].line))]


def _name(node: ast.AST) -> object:
    if isinstance(node, ast.Constant):
        return node.value
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
