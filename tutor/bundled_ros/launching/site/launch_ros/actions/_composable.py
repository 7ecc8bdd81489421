"""Composable nodes and their containers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from launch._entities import Action, LaunchDescriptionEntity, SomeSubstitutionsType, SomeSubstitutionsType_types_tuple
from launch._unsupported import refuse
from launch.launch_context import LaunchContext
from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions, perform_substitutions

from ..descriptions import ComposableNode
from ._node import Node

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
