"""The base of all that a launch description holds."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class LaunchDescriptionEntity:
    """Something that is visited, in order, when a launch description runs."""

    def describe(self) -> str:
        raise NotImplementedError

    def describe_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The entities that a visit of this one always brings."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """The entities that it may bring, each group with the condition in words."""
        return []

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Do what the entity does; the entities returned are visited next, before any other."""
        return None

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Done when nothing of this entity is going on any more; None where nothing ever was."""
        return None
