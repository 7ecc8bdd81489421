"""The base of all conditions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Condition:
    """Decides whether an action is executed."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate
        self._last_result: bool | None = None

    def describe(self) -> str:
        return repr(self)

    def evaluate(self, context: LaunchContext) -> bool:
        """Whether the action is executed; raises where that cannot be told."""
        self._last_result = self._predicate(context) if self._predicate is not None else False
        return self._last_result

    def last_evaluation_result(self) -> bool | None:
        """What `evaluate` said last, None before the first time."""
        return self._last_result
