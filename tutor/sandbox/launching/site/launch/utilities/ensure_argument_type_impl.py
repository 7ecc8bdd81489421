"""A check of an argument's type."""

from __future__ import annotations

from collections.abc import Iterable


def ensure_argument_type(
    argument: object, types: type | Iterable[type], argument_name: str, caller: str | None = None
) -> None:
    """TypeError where the argument is of none of the types."""
    allowed = (types,) if isinstance(types, type) else tuple(types)
    if isinstance(argument, allowed):
        return
    start = "Expected" if caller is None else f"'{caller}' expected"
    one_of = ", ".join(str(kind) for kind in allowed)
    raise TypeError(
        f"{start} '{argument_name}' to be one of [{one_of}], but got '{argument}' of type '{type(argument)}'"
    )
