"""What keeps a message from its level: a level set in the code, and a comparison that NaN passes."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from math import isnan, nan
from types import SimpleNamespace
from typing import Any

from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import calls_in


@mistake(
    "level-set-in-the-code",
    explains=[Symptom.LOGGED_TOO_OFTEN, Symptom.WRONG_LEVEL],
    says="{line} sets the level itself, whatever --log-level says: {code}",
    do="Leave the level to whoever starts the node.",
)
def level_set(case: Case) -> Iterator[Found]:
    """A node sets the level of its logger in its code.

    Which messages are made is up to whoever runs a node: INFO by default, `--log-level debug` to look for a fault. A
    level that is set in the code wins over the command line, and nobody can switch it without changing the program.

    Bad:

        self.get_logger().set_level(LoggingSeverity.DEBUG)

    Good:

        self.get_logger().debug('door at 43 %')

    See it: `ros2 run PACKAGE NODE --ros-args --log-level LEVEL` makes no difference.

    Lesson: b1.6, on levels.
    """
    logged = case.about("logged", ())
    lost = case.symptom is Symptom.WRONG_LEVEL and case.about("wanted") is Level.DEBUG
    if lost or all(log.level == Level.DEBUG for log in logged):
        for file in case.files:
            for call in file.calls("set_level", "set_logger_level"):
                yield found(file, call)


def _with_nan(*values: float) -> Any:
    """An event with these values, for an example."""
    return SimpleNamespace(event=SimpleNamespace(messages=tuple({"data": value} for value in values)), logs=())


@mistake(
    "nan-passes-every-comparison",
    name="NaN passes every comparison",
    explains=[Symptom.WRONG_LEVEL],
    evidence=Evidence.RUN,
    says="the reading is NaN, which is neither below nor above anything: each comparison with it is false",
    do="Ask whether the value is inside its range, and take everything else for broken.",
    example=in_run(Symptom.WRONG_LEVEL, event=_with_nan(nan)),
)
def nan_passes(case: Case) -> Iterator[Found]:
    """NaN is not found by looking for what is out of range.

    A sensor says NaN, not a number, when it does not know. Every comparison with NaN is false: it is not below the
    lowest value, and not above the highest one. Ask whether a value is inside the range, which NaN is not either.

    Bad:

        if weight < 0.0 or weight > 500.0:
            self.get_logger().error('no weight')

    Good:

        if not 0.0 <= weight <= 500.0:
            self.get_logger().error('no weight')

    See it: `python3 -c "print(float('nan') > 500.0)"`.

    Lesson: b1.6, not a number.
    """
    event = getattr(case.about("event"), "event", None)
    values = [value for message in getattr(event, "messages", ()) for value in message.values()]
    if not any(isinstance(value, float) and isnan(value) for value in values):
        return
    for file in case.files:
        for node in file.nodes:
            if _is_out_of_range(node) and not _knows_nan(file.function_around(node) or file.tree):
                yield found(file, node)
    compares = any(_is_order(node) for file in case.files for node in file.nodes)
    if compares and not any(_knows_nan(file.tree) for file in case.files):
        yield Found()


def _knows_nan(code: ast.AST) -> bool:
    """Whether a part of the code asks for NaN, or for what is within a range, which NaN is not."""
    return bool(calls_in(code, "isnan", "isfinite")) or any(_is_range(node) for node in ast.walk(code))


def _is_out_of_range(node: ast.AST) -> bool:
    """Whether this is a condition such as `x < 0 or x > 1`."""
    return (
        isinstance(node, ast.BoolOp)
        and isinstance(node.op, ast.Or)
        and sum(isinstance(value, ast.Compare) for value in node.values) > 1
    )


def _is_order(node: ast.AST) -> bool:
    """Whether this is a comparison such as `x > 1`."""
    return isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Lt | ast.LtE | ast.Gt | ast.GtE)


def _is_range(node: ast.AST) -> bool:
    """Whether this is a comparison such as `0 <= x <= 1`."""
    return isinstance(node, ast.Compare) and len(node.ops) > 1
