"""The description of a composable node, which is loaded into a container."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from launch._entities import Condition, SomeSubstitutionsType, Substitution
from launch.launch_context import LaunchContext
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue, normalize_parameters
from .utilities import RemapRule, SomeRemapRule, normalize_remap_rules

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]


class ComposableNode:
    """The package of the library, the plugin class in it, and the node's settings."""

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[SomeRemapRule] | None = None,
        extra_arguments: Sequence[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self._package = normalize_to_list_of_substitutions(package)
        self._plugin = normalize_to_list_of_substitutions(plugin)
        self._name = None if name is None else normalize_to_list_of_substitutions(name)
        self._namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self._parameters = None if parameters is None else normalize_parameters(parameters)
        self._remappings = list(normalize_remap_rules(remappings)) if remappings else None
        self._extra_arguments = normalize_parameters(extra_arguments) if extra_arguments else None
        self._condition = condition

    @property
    def package(self) -> list[Substitution]:
        return self._package

    @property
    def node_plugin(self) -> list[Substitution]:
        return self._plugin

    @property
    def node_name(self) -> list[Substitution] | None:
        return self._name

    @property
    def node_namespace(self) -> list[Substitution] | None:
        return self._namespace

    @property
    def parameters(self) -> Any:
        return self._parameters

    @property
    def remappings(self) -> list[RemapRule] | None:
        return self._remappings

    @property
    def extra_arguments(self) -> Any:
        return self._extra_arguments

    def condition(self) -> Condition | None:
        """Return the condition for loading the node; None: always."""
        return self._condition

    def is_wanted(self, context: LaunchContext) -> bool:
        """Return whether the node's condition holds, so that it is to be loaded."""
        return self._condition is None or self._condition.evaluate(context)

    def plugin_name(self, context: LaunchContext) -> str:
        """Return the plugin class's name, for messages."""
        return perform_substitutions(context, self._plugin)
