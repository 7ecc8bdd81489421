"""A message as `ros2 topic echo` writes it, and the numbers in it."""

from __future__ import annotations

import array
import itertools
import math
import sys
from collections.abc import Iterator
from typing import Any

import yaml

LONGEST = 128
"""Arrays and texts are cut after this many elements, as `ros2 topic echo` does."""

_MOST_FIELDS = 64
_MOST_ELEMENTS = 16


def to_yaml(message: Any) -> str:
    """The message as YAML in block style, long arrays and texts cut with an ellipsis."""
    return yaml.dump(
        _cut(message),
        Dumper=_Dumper,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=False,
        sort_keys=False,
    )


def numeric_fields(message: Any) -> tuple[str, ...]:
    """The paths of the numbers in a message, such as `pose.x` or `ranges[3]`; of long arrays the first ones only."""
    return tuple(itertools.islice(_numbers(message, ""), _MOST_FIELDS))


def number_at(message: Any, path: str) -> float | None:
    """The number at such a path; None where the message has none there now, or it is not finite."""
    value = message
    for step in path.replace("[", ".[").strip(".").split("."):
        try:
            value = value[int(step[1:-1])] if step.startswith("[") else getattr(value, step)
        except (AttributeError, IndexError, TypeError):
            return None
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


class _Dumper(yaml.SafeDumper):
    """Writes each value out: no anchors, even where one object stands in two places."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def _cut(value: Any) -> Any:
    if hasattr(value, "get_fields_and_field_types"):
        return {name: _cut(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, bytes):
        return _cut("".join(map(chr, value)))
    if isinstance(value, str):
        return value if len(value) <= LONGEST else f"{value[:LONGEST]}..."
    if is_array(value):
        items = [_cut(item) for item in value[:LONGEST]]
        return items if len(value) <= LONGEST else [*items, "..."]
    return value.item() if hasattr(value, "item") else value


def _numbers(value: Any, path: str) -> Iterator[str]:
    if hasattr(value, "get_fields_and_field_types"):
        for name in value.get_fields_and_field_types():
            yield from _numbers(getattr(value, name), f"{path}.{name}" if path else name)
    elif is_array(value):
        for index, item in enumerate(value[:_MOST_ELEMENTS]):
            yield from _numbers(item, f"{path}[{index}]")
    elif not isinstance(value, (str, bytes)):
        yield path  # a boolean is a number, too: it is plotted as 0 and 1


def is_array(value: Any) -> bool:
    """Whether a field's value is an array or a sequence, in whichever of the forms that rclpy gives them."""
    return isinstance(value, (list, tuple, array.array)) or (hasattr(value, "tolist") and hasattr(value, "__len__"))
