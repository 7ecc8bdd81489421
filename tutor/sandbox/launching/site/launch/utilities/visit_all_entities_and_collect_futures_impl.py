"""The visit of an entity and all below it."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from ..launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> list[tuple[LaunchDescriptionEntity, asyncio.Future[None]]]:
    """Visit depth first, in order; returns what is still going on, with the entity that it belongs to."""
    below = entity.visit(context)
    future = entity.get_asyncio_future()
    going_on = [(entity, future)] if future is not None else []
    for item in below or ():
        going_on += visit_all_entities_and_collect_futures(item, context)
    return going_on
