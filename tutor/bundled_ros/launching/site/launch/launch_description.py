"""The description of what to launch."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from ._entities import Action, LaunchDescriptionEntity
from .logging import get_logger

if TYPE_CHECKING:
    from .actions._composition import IncludeLaunchDescription
    from .actions._scope import DeclareLaunchArgument
    from .launch_context import LaunchContext

    ArgumentAndIncludes = tuple[DeclareLaunchArgument, list[IncludeLaunchDescription] | None]


class LaunchDescription(LaunchDescriptionEntity):
    """A list of entities, which are visited in order."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self._entities = list(initial_entities) if initial_entities is not None else []
        self._deprecated_reason = deprecated_reason

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        return self._entities

    @property
    def deprecated(self) -> bool:
        return self._deprecated_reason is not None

    @property
    def deprecated_reason(self) -> str | None:
        return self._deprecated_reason

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        self._entities.append(entity)

    def add_action(self, action: Action) -> None:
        self.add_entity(action)

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        if self._deprecated_reason is not None:
            where = context.get_locals_as_dict().get("current_launch_file_path")
            start = f"launch file [{where}] is deprecated" if where else "deprecated launch description"
            get_logger().warning(f"{start}: {self._deprecated_reason}")
        return self._entities

    def describe_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self._entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[DeclareLaunchArgument]:
        """Return the arguments declared here and in included files that can be read without running the launch."""
        found = self.get_launch_arguments_with_include_launch_description_actions(conditional_inclusion)
        return [argument for argument, _ in found]

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion: bool = False
    ) -> list[ArgumentAndIncludes]:
        """Return each argument (the first of its name) and the includes that lead to it (None: declared at the top)."""
        from .actions._composition import IncludeLaunchDescription
        from .actions._scope import DeclareLaunchArgument, ResetLaunchConfigurations

        found: dict[str, ArgumentAndIncludes] = {}

        def search(
            entities: Iterable[LaunchDescriptionEntity],
            conditional: bool,
            includes: list[IncludeLaunchDescription] | None,
        ) -> None:
            for entity in entities:
                if isinstance(entity, DeclareLaunchArgument):
                    if entity.name in found:
                        continue
                    entity._conditionally_included = conditional or entity.condition is not None
                    found[entity.name] = (entity, includes)
                if isinstance(entity, ResetLaunchConfigurations):
                    return  # later arguments cannot be set from outside
                inner = includes
                if isinstance(entity, IncludeLaunchDescription):
                    # The list is shared along the path, as in the original.
                    inner = inner if inner is not None else []
                    inner.append(entity)
                search(entity.describe_sub_entities(), False, inner)
                for _, sub_entities in entity.describe_conditional_sub_entities():
                    search(sub_entities, True, inner)

        search(self._entities, conditional_inclusion, None)
        return list(found.values())
