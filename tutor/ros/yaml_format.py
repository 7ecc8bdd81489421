"""Formats messages as `ros2 topic echo` does, and finds the numbers in them."""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import yaml

from tutor.ros.fast_yaml import dump_plain
from tutor.ros.messages import is_array, is_message

DEFAULT_MAX_LENGTH = 128
"""Arrays and strings are cut at this length, as `ros2 topic echo` does."""

_MAX_FIELDS = 64
_MAX_ELEMENTS = 16


def to_yaml(
    message: Any,
    *,
    max_length: int | None = DEFAULT_MAX_LENGTH,
    no_arrays: bool = False,
    no_strings: bool = False,
    flow_style: bool = False,
) -> str:
    """Return the message as block-style YAML, with arrays and strings cut at `max_length` elements with an ellipsis.

    `no_arrays` and `no_strings` show only their types and lengths; `flow_style` writes lists on one line.
    """
    if not (no_arrays or no_strings or flow_style) and (written := dump_plain(message, max_length)) is not None:
        return written
    return yaml.dump(
        _plain(message, _Options(max_length, no_arrays, no_strings)),
        Dumper=_Dumper,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=flow_style,
        sort_keys=False,
    )


def to_csv(
    message: Any, *, max_length: int | None = DEFAULT_MAX_LENGTH, no_arrays: bool = False, no_strings: bool = False
) -> str:
    """Return the message's values, separated by commas and cut as in `to_yaml`."""
    return _row(message, _Options(max_length, no_arrays, no_strings))


def numeric_fields(message: Any) -> tuple[str, ...]:
    """Return the paths of the numbers in a message, such as `pose.x` or `ranges[3]`; only the first of long arrays."""
    return tuple(itertools.islice(_number_paths(message, ""), _MAX_FIELDS))


def number_at(message: Any, path: str) -> float | None:
    """Return the number at a path from `numeric_fields`; None if this message has none there, or it is not finite."""
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


@dataclass(frozen=True, slots=True)
class _Options:
    max_length: int | None
    no_arrays: bool
    no_strings: bool

    def text(self, value: str) -> str:
        if self.no_strings:
            return f"<string length: <{len(value)}>>"
        return value if self.max_length is None or len(value) <= self.max_length else f"{value[: self.max_length]}..."


class _Dumper(yaml.SafeDumper):
    """Never writes anchors, even if an object occurs twice."""

    def ignore_aliases(self, data: Any) -> bool:
        return True

    def represent_message(self, data: dict[str, Any]) -> yaml.MappingNode:
        # Without an explicit style, a mapping is written as a block unless it is inside a flow-style list.
        pairs = [(self.represent_data(name), self.represent_data(value)) for name, value in data.items()]
        return yaml.MappingNode("tag:yaml.org,2002:map", pairs)


_Dumper.add_representer(dict, _Dumper.represent_message)


def _plain(value: Any, options: _Options) -> Any:
    if is_message(value):
        return {name: _plain_field(getattr(value, name), slot, options) for name, slot in _slots(value)}
    if isinstance(value, bytes):
        text = "".join(map(chr, value))
        return (
            text
            if options.max_length is None or len(text) <= options.max_length
            else f"{text[: options.max_length]}..."
        )
    if isinstance(value, str):
        return options.text(value)
    if is_array(value):
        items = [_plain(item, options) for item in value[: options.max_length]]
        return items if len(items) == len(value) else [*items, "..."]
    return value.item() if hasattr(value, "item") else value


def _plain_field(value: Any, slot: Any, options: _Options) -> Any:
    return _abbreviate(value, slot) if options.no_arrays and is_array(value) else _plain(value, options)


def _row(message: Any, options: _Options) -> str:
    return _join_cells(_cell(getattr(message, name), slot, options) for name, slot in _slots(message))


def _cell(value: Any, slot: Any, options: _Options) -> str:
    """Return one cell. `slot` is None for an element of an array."""
    if is_array(value):
        if options.no_arrays and slot is not None:
            return _abbreviate(value, slot)
        more = ["..."] if options.max_length is not None and len(value) > options.max_length else []
        return _join_cells([*(_cell(item, None, options) for item in value[: options.max_length]), *more])
    if is_message(value):
        return _row(value, options)
    if isinstance(value, bytes) and options.max_length is not None and len(value) > options.max_length:
        return str(value[: options.max_length] + b"...")
    return options.text(value) if isinstance(value, str) else str(value)


def _join_cells(cells: Iterable[str]) -> str:
    """Join with commas as rosidl_runtime_py does: no comma as long as all cells so far are empty."""
    row = ""
    for cell in cells:
        row = f"{row},{cell}" if row else cell
    return row


def _slots(message: Any) -> Iterator[tuple[str, Any]]:
    return zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True)


def _abbreviate(value: Any, slot: Any) -> str:
    value_type = slot.value_type
    names = getattr(value_type, "namespaced_name", None)
    element = (
        "/".join(names())
        if names
        else getattr(value_type, "typename", None) or type(value_type).__name__.lower().split("bounded")[-1]
    )
    if hasattr(slot, "size"):
        return f"<array type: {element}[{slot.size}]>"
    bound = f"[{slot.maximum_size}]" if hasattr(slot, "maximum_size") else ""
    return f"<sequence type: {element}{bound}, length: {len(value)}>"


def _number_paths(value: Any, path: str) -> Iterator[str]:
    if is_message(value):
        for name in value.get_fields_and_field_types():
            yield from _number_paths(getattr(value, name), f"{path}.{name}" if path else name)
    elif is_array(value):
        for index, item in enumerate(value[:_MAX_ELEMENTS]):
            yield from _number_paths(item, f"{path}[{index}]")
    elif not isinstance(value, (str, bytes)):
        yield path  # booleans count as numbers: they are plotted as 0 and 1
