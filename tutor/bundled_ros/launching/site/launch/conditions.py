"""Conditions on actions."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

from ._entities import Condition, SomeSubstitutionsType, Substitution
from .launch_context import LaunchContext
from .utilities import normalize_to_list_of_substitutions, perform_substitutions

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]


class InvalidConditionExpressionError(ValueError):
    """A condition's text is neither true nor false."""

    def __init__(
        self, expression: str, unexpanded_expression: Sequence[Substitution], valid_expressions: Sequence[str]
    ) -> None:
        came_from = " + ".join(item.describe() for item in unexpanded_expression)
        super().__init__(
            f"invalid condition expression, expected one of [{', '.join(valid_expressions)}] "
            f"but got '{expression}', expanded from '{came_from}'"
        )


TRUE = ["true", "1"]
FALSE = ["false", "0"]


def evaluate_condition_expression(context: LaunchContext, expression: Sequence[Substitution]) -> bool:
    """Evaluate a condition, ignoring case. Raises InvalidConditionExpressionError for any word not listed above."""
    word = perform_substitutions(context, expression).strip().lower()
    if word in TRUE:
        return True
    if word in FALSE:
        return False
    raise InvalidConditionExpressionError(word, expression, TRUE + FALSE)


class IfCondition(Condition):
    """Executes an action if the expression is true."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=self._is_met)

    def _is_met(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self._expression)


class UnlessCondition(IfCondition):
    """Executes an action if the expression is false."""

    def _is_met(self, context: LaunchContext) -> bool:
        return not super()._is_met(context)


class LaunchConfigurationEquals(Condition):
    """True if the launch configuration has this value (None: if it is not set)."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        warnings.warn(
            f"{type(self).__name__} is deprecated. Use IfCondition with EqualsSubstitution or NotEqualsSubstitution.",
            UserWarning,
            stacklevel=2,
        )
        self._name = launch_configuration_name
        self._expected = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        super().__init__(predicate=self._is_met)

    def _is_met(self, context: LaunchContext) -> bool:
        expected = None if self._expected is None else perform_substitutions(context, self._expected)
        value = context.launch_configurations.get(self._name)
        return bool(value == expected)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """True if the launch configuration has any other value."""

    def _is_met(self, context: LaunchContext) -> bool:
        return not super()._is_met(context)
