"""Composable nodes and their containers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from tutor.bundled_ros.launching.launch.base import (
    LaunchContext,
    LaunchDescriptionEntity,
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)
from tutor.bundled_ros.launching.launch.entities import Action, Condition
from tutor.bundled_ros.launching.launch.errors import refuse
from tutor.bundled_ros.launching.launch.values import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from tutor.bundled_ros.launching.launch_ros.names import SomeRemapRule, normalize_remap_rules
from tutor.bundled_ros.launching.launch_ros.node import Node
from tutor.bundled_ros.launching.launch_ros.parameters import normalize_parameters


class ComposableNode:
    """The library's package, the plugin class in it, and the node's settings, which are only checked."""

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
        for text in (package, name, namespace):
            if text is not None:
                normalize_to_list_of_substitutions(text)
        if parameters is not None:
            normalize_parameters(parameters)
        if extra_arguments:
            normalize_parameters(extra_arguments)
        list(normalize_remap_rules(remappings or ()))
        self._plugin = normalize_to_list_of_substitutions(plugin)
        self._condition = condition

    def condition(self) -> Condition | None:
        """Return the condition for loading the node; None: always."""
        return self._condition

    def is_wanted(self, context: LaunchContext) -> bool:
        """Return whether the node's condition holds, so that it is to be loaded."""
        return self._condition is None or self._condition.evaluate(context)

    def plugin_name(self, context: LaunchContext) -> str:
        """Return the plugin class's name, for messages."""
        return perform_substitutions(context, self._plugin)


CONTAINERS = "rclcpp_components"
"""The package of the usual containers, which are C++."""


class ComposableNodeContainer(Node):
    """Starts a container as a plain node. Loading nodes into it needs an installed ROS 2."""

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self._descriptions = list(composable_node_descriptions or ())

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        nodes = [node for node in self._descriptions if node.is_wanted(context)]
        if nodes:
            refuse(f"loading the composable node {nodes[0].plugin_name(context)} into a container")
        package = (
            ""
            if self.node_package is None
            else perform_substitutions(context, normalize_to_list_of_substitutions(self.node_package))
        )
        if package == CONTAINERS:
            refuse(f"a container of {CONTAINERS}")
        return super().execute(context)


class LoadComposableNodes(Action):
    """Raises NotSupportedError, since loading needs an installed ROS 2, unless no node's condition holds."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **kwargs: Any,
    ) -> None:
        allowed = (*SomeSubstitutionsType_types_tuple, ComposableNodeContainer)
        ensure_argument_type(target_container, allowed, "target_container", "LoadComposableNodes")
        super().__init__(**kwargs)
        self._descriptions = list(composable_node_descriptions)

    def execute(self, context: LaunchContext) -> None:
        for node in self._descriptions:
            if node.is_wanted(context):
                refuse(f"loading the composable node {node.plugin_name(context)} into a container")
