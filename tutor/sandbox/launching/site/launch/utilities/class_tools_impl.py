"""Questions about classes."""

from __future__ import annotations


def is_a(obj: object, entity_type: type) -> bool:
    """Whether `obj` is an instance."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Whether `obj` is an instance, or itself a class derived from it."""
    return isinstance(obj, entity_type) or (isinstance(obj, type) and issubclass(obj, entity_type))
