"""Nodes for a container that runs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch._unsupported import refuse
from launch.action import Action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple
from launch.utilities import ensure_argument_type

from ..descriptions.composable_node import ComposableNode
from .composable_node_container import ComposableNodeContainer


class LoadComposableNodes(Action):
    """Refuses to load nodes: that needs an installed ROS 2. Where the conditions of all say no, there are none."""

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
                refuse(f"loading the composable node {node.shown(context)} into a container")
