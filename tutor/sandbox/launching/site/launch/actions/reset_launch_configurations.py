"""Launch configurations anew."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..action import Action
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions


class ResetLaunchConfigurations(Action):
    """Forgets all launch configurations but those given, whose values may still use the old ones."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._kept = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        kept = {
            perform_substitutions(context, normalize_to_list_of_substitutions(name)): _value(context, value)
            for name, value in self._kept.items()
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)


def _value(context: LaunchContext, value: Any) -> Any:
    """A text or a substitution as its text. Anything else, a list among it, stays what it is, as in the original."""
    if not isinstance(value, str | Substitution):
        return value
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))
