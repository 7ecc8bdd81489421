"""Entities and lists of entities, as one list."""

from __future__ import annotations

from collections.abc import Iterable

from ..launch_description_entity import LaunchDescriptionEntity
from ..some_entities_type import SomeEntitiesType


def normalize_to_list_of_entities(entities: Iterable[SomeEntitiesType]) -> list[LaunchDescriptionEntity]:
    """Flatten one level of lists."""
    flat: list[LaunchDescriptionEntity] = []
    for item in entities:
        flat.extend([item] if isinstance(item, LaunchDescriptionEntity) else item)
    return flat
