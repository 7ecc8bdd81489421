"""Functions that are named where they should be called."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import EVERY_SYMPTOM, Case, Found, found, mistake
from tutor.source import NodeFile, last_name

_METHODS = frozenset(
    {"cancel", "destroy", "publish", "reset", "shutdown", "spin", "spin_once", "start", "try_shutdown"}
)
"""Methods of ROS and of threads that are called for what they do, not for what they return."""


@mistake(
    "function-not-called",
    name="parentheses missing",
    explains=[symptom for symptom in EVERY_SYMPTOM if symptom is not Symptom.WRONG_NAMES],
    slip=True,
    says="{line} names {name}, and does not call it: {code}",
    do="Add the parentheses behind {name} there.",
)
def function_not_called(case: Case) -> Iterator[Found]:
    """A function is named, and not called.

    What calls a function is the pair of parentheses behind its name. A line with the name alone is allowed, and does
    nothing; so does a lambda that gives back a function in place of calling it.

    Bad:

        def ring(self):
            self.bell.publish

    Good:

        def ring(self):
            self.bell.publish(Empty())

    See it: a log message in the function never appears; a linter says "useless expression".
    """
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.Expr(value=ast.Attribute() | ast.Name() as named) if _is_function(file, named):
                    yield found(file, named, name=last_name(named))
                case ast.Lambda(body=ast.Attribute() as named) if file.functions_named(named.attr):
                    yield found(file, named, name=last_name(named))


def _is_function(file: NodeFile, named: ast.expr) -> bool:
    name = last_name(named)
    return bool(file.functions_named(name)) or (isinstance(named, ast.Attribute) and name in _METHODS)
