"""Whether two texts mean the same."""

from __future__ import annotations

import math
from typing import Any

from ..launch_context import LaunchContext
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions
from ..utilities.type_utils import is_substitution

TRUE, FALSE = ("true", "1"), ("false", "0")


class EqualsSubstitution(Substitution):
    """`true` where both are the same truth value, the same number, or the same text."""

    def __init__(self, left: Any, right: Any) -> None:
        self._left = normalize_to_list_of_substitutions(_text(left))
        self._right = normalize_to_list_of_substitutions(_text(right))

    @property
    def left(self) -> list[Substitution]:
        return self._left

    @property
    def right(self) -> list[Substitution]:
        return self._right

    def describe(self) -> str:
        return f"{type(self).__name__}({self._left} {self._right})"

    def perform(self, context: LaunchContext) -> str:
        return str(self._equal(context)).lower()

    def _equal(self, context: LaunchContext) -> bool:
        left, right = perform_substitutions(context, self._left), perform_substitutions(context, self._right)
        truths = [_truth(left), _truth(right)]
        if None not in truths:
            return truths[0] == truths[1]
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right


def _text(value: Any) -> Any:
    if is_substitution(value):
        return value
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _truth(text: str) -> bool | None:
    return True if text.lower() in TRUE else False if text.lower() in FALSE else None
