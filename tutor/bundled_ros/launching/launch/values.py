"""Substitutions and other values as launch files give them: normalized, performed, and converted to a type."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, get_args, get_origin

import yaml

from tutor.bundled_ros.launching.launch.base import (
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    Substitution,
)


class SubstitutionFailure(RuntimeError):  # noqa: N818, RUF100 - the original's name
    """A substitution cannot be performed."""


class TextSubstitution(Substitution):
    """A literal text. Raises TypeError for anything else."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expected Text object got '{type(text)}' instead.")
        self._text = text

    @property
    def text(self) -> str:
        return self._text

    def describe(self) -> str:
        return f"'{self._text}'"

    def perform(self, context: LaunchContext) -> str:
        return self._text


def normalize_to_list_of_entities(entities: Iterable[SomeEntitiesType]) -> list[LaunchDescriptionEntity]:
    """Flatten one level of lists."""
    flat: list[LaunchDescriptionEntity] = []
    for item in entities:
        flat.extend([item] if isinstance(item, LaunchDescriptionEntity) else item)
    return flat


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Return whether `obj` is an instance or a subclass of the type."""
    return isinstance(obj, entity_type) or (isinstance(obj, type) and issubclass(obj, entity_type))


def ensure_argument_type(
    argument: object, types: type | Iterable[type], argument_name: str, caller: str | None = None
) -> None:
    """Raise TypeError unless the argument is of one of the types."""
    allowed = (types,) if isinstance(types, type) else tuple(types)
    if isinstance(argument, allowed):
        return
    start = "Expected" if caller is None else f"'{caller}' expected"
    one_of = ", ".join(str(kind) for kind in allowed)
    raise TypeError(
        f"{start} '{argument_name}' to be one of [{one_of}], but got '{argument}' of type '{type(argument)}'"
    )


def normalize_to_list_of_substitutions(subs: Any) -> list[Substitution]:
    """Convert a text, a path, a substitution or an iterable of them to a list. Raises TypeError for anything else."""
    if isinstance(subs, str | Path | Substitution):
        return [_to_substitution(subs)]
    return [_to_substitution(item) for item in subs]


def _to_substitution(item: object) -> Substitution:
    if isinstance(item, Substitution):
        return item
    if isinstance(item, str | Path):
        return TextSubstitution(text=os.fspath(item))
    raise TypeError(
        f"Failed to normalize given item of type '{type(item)}', when only 'str', 'pathlib.Path' or "
        "'launch.Substitution' were expected."
    )


def perform_substitutions(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """Return the substitutions' texts, concatenated."""
    return "".join([context.perform_substitution(item) for item in subs])


SCALARS = (int, float, bool, str)


def extract_type(data_type: Any) -> tuple[Any, bool]:
    """Return the scalar type and whether a list of it is meant. Raises ValueError for any other type."""
    is_list = get_origin(data_type) is list
    scalar = get_args(data_type)[0] if is_list else data_type
    if scalar not in SCALARS:
        raise ValueError(f"Unrecognized data type: {data_type}")
    return scalar, is_list


def is_substitution(value: Any) -> bool:
    """Return whether the value is a substitution, or a sequence of texts and at least one substitution."""
    if isinstance(value, Substitution):
        return True
    return (
        isinstance(value, Sequence)
        and not isinstance(value, str)
        and all(isinstance(item, Substitution | str) for item in value)
        and any(isinstance(item, Substitution) for item in value)
    )


def is_normalized_substitution(value: Any) -> bool:
    """Return whether the value is a non-empty list of substitutions only."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, Substitution) for item in value)


def normalize_typed_substitution(value: Any, data_type: Any) -> Any:
    """Normalize a typed value: scalars stay, substitutions become lists, and lists are normalized item by item.

    Raises TypeError if the value does not match the type.
    """
    if isinstance(value, SCALARS):
        _require_instance(value, data_type)
        return value
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if not isinstance(value, Iterable):
        raise TypeError(
            f"value should be a scalar, a substitution or a list of them. Got '{value}' of type {type(value)}"
        )
    if data_type is not None and not extract_type(data_type)[1]:
        raise TypeError(f"got the list '{value}', though a {data_type} is required")
    scalar = None if data_type is None else extract_type(data_type)[0]
    items = [normalize_to_list_of_substitutions(item) if is_substitution(item) else item for item in value]
    kinds = {type(item) for item in items if not isinstance(item, list)}
    if not kinds <= set(SCALARS):
        raise TypeError(f"an item of '{value}' is neither a scalar nor a substitution")
    if kinds == {int, float} or (kinds == {int} and scalar is float):
        items = [item if isinstance(item, list) else float(item) for item in items]
        kinds = {float}
    if len(kinds) > 1 or (scalar is not None and kinds and kinds != {scalar}):
        raise TypeError(f"the items of '{value}' are not all of one type, as required: {scalar or kinds}")
    return items


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any) -> Any:
    """Return the value converted to a type (None: the type that YAML gives it). Raises ValueError or TypeError."""
    if isinstance(value, SCALARS):
        _require_instance(value, data_type)
        return value
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    if not isinstance(value, list):
        raise TypeError(f"value is neither a scalar, a substitution nor a list of them: '{value}'")
    scalar = None if data_type is None else extract_type(data_type)[0]
    items = [
        coerce_to_type(perform_substitutions(context, item), scalar) if is_normalized_substitution(item) else item
        for item in value
    ]
    if len({type(item) for item in items}) > 1:
        raise ValueError(f"The output list is not uniform: {items}")
    return items


def coerce_to_type(value: str, data_type: Any = None) -> Any:
    """Convert a text to a type (None: the type that YAML gives it). Raises ValueError if that is impossible."""
    if data_type is None:
        loaded = _load_yaml(value, f"Failed to convert '{value}' using yaml rules")
        kinds = {type(item) for item in loaded} if isinstance(loaded, list) else {type(loaded)}
        if len(kinds) > 1 or not kinds <= set(SCALARS):
            raise ValueError(
                f"Failed to convert '{value}' using yaml rules: output type is not allowed, got {loaded!r}"
            )
        return loaded
    scalar, is_list = extract_type(data_type)
    if is_list:
        message = f"Cannot convert value '{value}' to a list of '{scalar}'"
        loaded = _load_yaml(value, message)
        if not isinstance(loaded, list) or not all(isinstance(item, scalar) for item in loaded):
            raise ValueError(message)
        return loaded
    if scalar is str:
        return value
    if scalar is bool:
        loaded = _load_yaml({"1": "true", "0": "false"}.get(value, value), f"Failed to convert '{value}' to '{bool}'")
        if not isinstance(loaded, bool):
            raise ValueError(f"Cannot convert value '{value}' to '{bool}'")
        return loaded
    return scalar(value)


def _load_yaml(value: str, message: str) -> Any:
    if not value:
        return value
    try:
        return yaml.safe_load(value)
    except yaml.YAMLError as error:
        raise ValueError(f"{message}: yaml.safe_load() failed\n{error}") from error


def _require_instance(value: object, data_type: Any) -> None:
    if data_type is None:
        return
    scalar, is_list = extract_type(data_type)
    if is_list or not isinstance(value, scalar):
        raise TypeError(f"value='{value}' is not an instance of {data_type}")


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> list[tuple[LaunchDescriptionEntity, asyncio.Future[None]]]:
    """Visit entities depth-first, in order. Return each unfinished entity with its future."""
    sub_entities = entity.visit(context)
    future = entity.get_asyncio_future()
    pending = [(entity, future)] if future is not None else []
    for item in sub_entities or ():
        pending += visit_all_entities_and_collect_futures(item, context)
    return pending
