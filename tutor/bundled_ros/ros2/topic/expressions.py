"""The Python expression of `--filter`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tutor.errors import CommandError


def compile_filter(text: str | None) -> Callable[[Any], bool] | None:
    """Compile an expression into a predicate on a message `m`; None if there is no expression.

    The compilation and the predicate raise CommandError. The expression is the user's own code, run with their own
    privileges, like any Python that they type.
    """
    if text is None:
        return None
    try:
        code = compile(text, "--filter", "eval")
    except (SyntaxError, ValueError) as error:
        raise CommandError(f"--filter {text}: {error}") from error

    def matches(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except Exception as error:  # whatever the user's code may raise
            raise CommandError(f"--filter {text}: {type(error).__name__}: {error}") from error

    return matches
