"""One of the context's locals."""

from __future__ import annotations

from ..launch_context import LaunchContext
from ..substitution import Substitution
from ..utilities.ensure_argument_type_impl import ensure_argument_type


class LocalSubstitution(Substitution):
    """An expression on the locals, `event.reason` for instance."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        ensure_argument_type(expression, str, "expression", "LocalSubstitution")
        self._expression = expression
        self._description = description

    @property
    def expression(self) -> str:
        return self._expression

    @property
    def description(self) -> str | None:
        return self._description

    def describe(self) -> str:
        return f"LocalVar('{self._expression if self._description is None else self._description}')"

    def perform(self, context: LaunchContext) -> str:
        value: str = eval("locals_of_context." + self._expression, {"locals_of_context": context.locals})
        return value
