"""A condition that is neither true nor false."""

from __future__ import annotations

from collections.abc import Sequence

from ..substitution import Substitution


class InvalidConditionExpressionError(ValueError):
    """Says what was expected, what came, and what it came from."""

    def __init__(
        self, expression: str, unexpanded_expression: Sequence[Substitution], valid_expressions: Sequence[str]
    ) -> None:
        came_from = " + ".join(item.describe() for item in unexpanded_expression)
        super().__init__(
            f"invalid condition expression, expected one of [{', '.join(valid_expressions)}] "
            f"but got '{expression}', expanded from '{came_from}'"
        )
