"""Exceptions that the learner's own code catches, and of which it logs or prints only the message."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import replace

from tutor.judge.causes.exceptions import diagnose_known_exception
from tutor.judge.source import all_nodes, file_holding
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.judge.verdict import Cause

_MISTAKES: tuple[tuple[str, re.Pattern[str], type[ast.Attribute | ast.Name]], ...] = (
    ("AttributeError", re.compile(r"\S+ (?:object )?'?[\w.]*'? ?has no attribute '(?P<name>\w+)'.*"), ast.Attribute),
    ("NameError", re.compile(r"name '(?P<name>\w+)' is not defined.*"), ast.Name),
    ("UnboundLocalError", re.compile(r"cannot access local variable '(?P<name>\w+)'.*"), ast.Name),
)
"""Exceptions that are always mistakes: type, message, and the kind of expression that the name in it stands for."""

_BROAD = ("Exception", "BaseException", *(kind for kind, _, _ in _MISTAKES))


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


def _lines_with(trace: Trace, expression: type[ast.Attribute | ast.Name], name: str) -> list[Frame]:
    """The learner's lines in which an expression of this kind has this name, those that assign to it first."""

    def find() -> Iterator[tuple[bool, Frame]]:
        for node in all_nodes(trace):
            if isinstance(node, expression) and (node.attr if isinstance(node, ast.Attribute) else node.id) == name:
                file = file_holding(trace, node)
                code = file.text.splitlines()[node.lineno - 1].strip()
                path = f"{trace.folder}/{file.file or trace.file}"
                yield isinstance(node.ctx, ast.Load), Frame(path, node.lineno, "", code)

    return [frame for _, frame in sorted(find(), key=lambda each: (each[0], each[1].line))]
