"""A message as `ros2 topic echo` writes it, and the numbers in it."""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import yaml

from tutor.ros.fast_yaml import dump_plain, is_array

__all__ = ["LONGEST", "is_array", "number_at", "numeric_fields", "to_csv", "to_yaml"]

LONGEST = 128
"""Arrays and texts are cut after this many elements, as `ros2 topic echo` does."""

_MOST_FIELDS = 64
_MOST_ELEMENTS = 16


def to_yaml(
    message: Any,
    *,
    longest: int | None = LONGEST,
    no_arrays: bool = False,
    no_texts: bool = False,
    flow_style: bool = False,
) -> str:
    """The message as YAML in block style, with arrays and texts of more than `longest` elements cut with an ellipsis.

    `no_arrays` and `no_texts` give only their types and lengths; `flow_style` writes lists in one line.
    """
    if not (no_arrays or no_texts or flow_style) and (written := dump_plain(message, longest)) is not None:
        return written
    return yaml.dump(
        _plain(message, _Form(longest, no_arrays, no_texts)),
        Dumper=_Dumper,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=flow_style,
        sort_keys=False,
    )


def to_csv(message: Any, *, longest: int | None = LONGEST, no_arrays: bool = False, no_texts: bool = False) -> str:
    """The message's values, separated by commas, cut as in `to_yaml`."""
    return _row(message, _Form(longest, no_arrays, no_texts))


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


@dataclass(frozen=True, slots=True)
class _Form:
    longest: int | None
    no_arrays: bool
    no_texts: bool

    def text(self, value: str) -> str:
        if self.no_texts:
            return f"<string length: <{len(value)}>>"
        return value if self.longest is None or len(value) <= self.longest else f"{value[: self.longest]}..."


class _Dumper(yaml.SafeDumper):
    """Writes no anchors, even where one object occurs twice."""

    def ignore_aliases(self, data: Any) -> bool:
        return True

    def represent_message(self, data: dict[str, Any]) -> yaml.MappingNode:
        # Without a style of its own, a mapping is a block unless it is within a list in flow style.
        pairs = [(self.represent_data(name), self.represent_data(value)) for name, value in data.items()]
        return yaml.MappingNode("tag:yaml.org,2002:map", pairs)


_Dumper.add_representer(dict, _Dumper.represent_message)


def _plain(value: Any, form: _Form) -> Any:
    if hasattr(value, "get_fields_and_field_types"):
        return {name: _plain_field(getattr(value, name), slot, form) for name, slot in _slots(value)}
    if isinstance(value, bytes):
        text = "".join(map(chr, value))
        return text if form.longest is None or len(text) <= form.longest else f"{text[: form.longest]}..."
    if isinstance(value, str):
        return form.text(value)
    if is_array(value):
        items = [_plain(item, form) for item in value[: form.longest]]
        return items if len(items) == len(value) else [*items, "..."]
    return value.item() if hasattr(value, "item") else value


def _plain_field(value: Any, slot: Any, form: _Form) -> Any:
    return _abbreviated(value, slot) if form.no_arrays and is_array(value) else _plain(value, form)


def _row(message: Any, form: _Form) -> str:
    return _joined(_cell(getattr(message, name), slot, form) for name, slot in _slots(message))


def _cell(value: Any, slot: Any, form: _Form) -> str:
    """`slot` is None for an element of an array."""
    if is_array(value):
        if form.no_arrays and slot is not None:
            return _abbreviated(value, slot)
        more = ["..."] if form.longest is not None and len(value) > form.longest else []
        return _joined([*(_cell(item, None, form) for item in value[: form.longest]), *more])
    if hasattr(value, "get_fields_and_field_types"):
        return _row(value, form)
    if isinstance(value, bytes) and form.longest is not None and len(value) > form.longest:
        return str(value[: form.longest] + b"...")
    return form.text(value) if isinstance(value, str) else str(value)


def _joined(cells: Iterable[str]) -> str:
    """With commas, as rosidl_runtime_py sets them: none after cells that are empty, as long as nothing came before."""
    row = ""
    for cell in cells:
        row = f"{row},{cell}" if row else cell
    return row


def _slots(message: Any) -> Iterator[tuple[str, Any]]:
    return zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True)


def _abbreviated(value: Any, slot: Any) -> str:
    of = slot.value_type
    names = getattr(of, "namespaced_name", None)
    element = (
        "/".join(names()) if names else getattr(of, "typename", None) or type(of).__name__.lower().split("bounded")[-1]
    )
    if hasattr(slot, "size"):
        return f"<array type: {element}[{slot.size}]>"
    bound = f"[{slot.maximum_size}]" if hasattr(slot, "maximum_size") else ""
    return f"<sequence type: {element}{bound}, length: {len(value)}>"


def _numbers(value: Any, path: str) -> Iterator[str]:
    if hasattr(value, "get_fields_and_field_types"):
        for name in value.get_fields_and_field_types():
            yield from _numbers(getattr(value, name), f"{path}.{name}" if path else name)
    elif is_array(value):
        for index, item in enumerate(value[:_MOST_ELEMENTS]):
            yield from _numbers(item, f"{path}[{index}]")
    elif not isinstance(value, (str, bytes)):
        yield path  # a boolean is a number, too: it is plotted as 0 and 1
