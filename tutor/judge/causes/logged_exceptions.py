"""Exceptions that the learner's own code catches, and of which it logs or prints only the message."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import replace

from tutor.judge.causes.exceptions import diagnose_known_exception
from tutor.judge.source import all_nodes, calls, file_holding
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.judge.verdict import Cause

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


def diagnose_logged_exception(trace: Trace) -> Cause | None:
    """The last exception that is always a mistake and whose message is in the log or the output."""
    if not any(_catches_mistakes(each) for each in all_nodes(trace)):
        return None
    for text in reversed([*(line.text for line in trace.output), *(log.text for log in trace.logs)]):
        for kind, message, expression in _MISTAKES:
            if (found := message.search(text)) and (lines := _lines_with(trace, expression, found["name"])):
                cause = diagnose_known_exception(Traceback(kind, found[0], (lines[0],)), trace)
                return cause and replace(cause, text=f"{cause.text} (your code catches it, and only logs it)")
    return None


def _catches_mistakes(node: ast.AST) -> bool:
    if not isinstance(node, ast.ExceptHandler):
        return False
    return node.type is None or any(isinstance(each, ast.Name) and each.id in _BROAD for each in ast.walk(node.type))


def _lines_with(trace: Trace, expression: _Expression, name: str) -> list[Frame]:
    """The learner's lines in which an expression of this kind has this name, those that assign to it first.

    A parameter's name is only looked for where it is read.
    """

    def find() -> Iterator[tuple[bool, Frame]]:
        read = [each for call in calls(trace, "get_parameter", "get_parameters") for each in ast.walk(call)]
        for node in all_nodes(trace):
            if isinstance(node, expression) and _name(node) == name:
                if isinstance(node, ast.Constant) and node not in read:
                    continue
                file = file_holding(trace, node)
                code = file.text.splitlines()[node.lineno - 1].strip()
                path = f"{trace.folder}/{file.file or trace.file}"
                yield (
                    isinstance(node, ast.Constant) or isinstance(node.ctx, ast.Load),
                    Frame(path, node.lineno, "", code),
                )

    return [frame for _, frame in sorted(find(), key=lambda each: (each[0], each[1].line))]


def _name(node: ast.Attribute | ast.Name | ast.Constant) -> object:
    if isinstance(node, ast.Constant):
        return node.value
    return node.attr if isinstance(node, ast.Attribute) else node.id
