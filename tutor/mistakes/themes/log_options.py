"""Options of a log call that keep messages back."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.source import called_name

_METHODS = ("debug", "info", "warning", "warn", "error", "fatal", "log")
_OPTIONS = {
    "throttle_duration_sec": "at most one message in that many seconds",
    "once": "only the first message",
    "skip_first": "every message but the first",
}


@mistake(
    "log-call-keeps-messages-back",
    explains=[Symptom.NOT_LOGGED, Symptom.WRONG_LOG],
    says="{line} logs {what}, since it has {option}: {code}",
    do="Leave out that option where every message counts.",
)
def kept_back(case: Case) -> Iterator[Found]:
    """An option of a log call drops messages.

    throttle_duration_sec, once and skip_first are meant for a line that would flood the log. What they drop is gone: it
    is not logged later.

    Bad:

        self.get_logger().info(f'visitor {self.visitors}', throttle_duration_sec=60.0)

    Good:

        self.get_logger().info(f'visitor {self.visitors}')

    See it: count the lines of `ros2 topic echo /rosout`.
    """
    for file in case.files if "rate" not in case.about("fault", "") else ():
        for node in file.nodes:
            if isinstance(node, ast.Call) and called_name(node) in _METHODS:
                for given in node.keywords:
                    if given.arg in _OPTIONS and not _is_off(given.value):
                        yield found(file, node, option=given.arg, what=_OPTIONS[given.arg])


def _is_off(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and not value.value
