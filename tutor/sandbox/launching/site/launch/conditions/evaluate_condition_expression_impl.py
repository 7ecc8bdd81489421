"""A text as a truth value."""

from __future__ import annotations

from collections.abc import Sequence

from ..launch_context import LaunchContext
from ..substitution import Substitution
from ..utilities.perform_substitutions_impl import perform_substitutions
from .invalid_condition_expression_error import InvalidConditionExpressionError

TRUE = ["true", "1"]
FALSE = ["false", "0"]


def evaluate_condition_expression(context: LaunchContext, expression: Sequence[Substitution]) -> bool:
    """True or false; InvalidConditionExpressionError for any word but those above, in any case."""
    word = perform_substitutions(context, expression).strip().lower()
    if word in TRUE:
        return True
    if word in FALSE:
        return False
    raise InvalidConditionExpressionError(word, expression, TRUE + FALSE)
