"""The Python expressions of `--filter`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tutor.errors import CommandError


def expression(text: str | None) -> Callable[[Any], bool] | None:
    """The expression as a function of a message `m`; None where there is none. It raises CommandError.

    It is code of the user's own, run with their rights, as any Python that they type.
    """
    if text is None:
        return None
    try:
        code = compile(text, "--filter", "eval")
    except (SyntaxError, ValueError) as error:
        raise CommandError(f"--filter {text}: {error}") from error

    def holds(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except Exception as error:  # whatever the user's code may raise
            raise CommandError(f"--filter {text}: {type(error).__name__}: {error}") from error

    return holds
