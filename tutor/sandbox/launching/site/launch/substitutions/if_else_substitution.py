"""One of two texts."""

from __future__ import annotations

from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions
from ..utilities.type_utils import perform_typed_substitution
from .substitution_failure import SubstitutionFailure


class IfElseSubstitution(Substitution):
    """The first text where the condition is true, else the second."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if if_value == else_value == "":
            raise RuntimeError("One of if_value and else_value must be specified")
        self._condition = normalize_to_list_of_substitutions(condition)
        self._if = normalize_to_list_of_substitutions(if_value)
        self._else = normalize_to_list_of_substitutions(else_value)

    @property
    def condition(self) -> list[Substitution]:
        return self._condition

    @property
    def if_value(self) -> list[Substitution]:
        return self._if

    @property
    def else_value(self) -> list[Substitution]:
        return self._else

    def describe(self) -> str:
        return f"IfElseSubstitution({self._condition}, {self._if}, {self._else})"

    def perform(self, context: LaunchContext) -> str:
        try:
            chosen = self._if if perform_typed_substitution(context, self._condition, bool) else self._else
        except (TypeError, ValueError) as error:
            raise SubstitutionFailure(error) from error
        return perform_substitutions(context, chosen)
