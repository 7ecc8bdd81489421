"""What a value in a message is, and messages as plain data, whole or within limits."""

from __future__ import annotations

import array
from typing import Any

MAX_CHARACTERS, MAX_ELEMENTS = 10_000, 100_000
"""Limits on what is kept: characters of each string, and array elements of a whole message."""

_ELEMENT_BYTES = 16
RECEIVED_PER_KEPT_BYTE = 8
"""Received bytes that are not kept count as one kept byte per this many."""


def is_message(value: Any) -> bool:
    """Return whether a value is a ROS message rather than one of Python's or numpy's."""
    return hasattr(value, "get_fields_and_field_types")


def is_array(value: Any) -> bool:
    """Return whether a field's value is an array or a sequence, in any form that rclpy uses."""
    return isinstance(value, (list, tuple, array.array)) or (hasattr(value, "tolist") and hasattr(value, "__len__"))


def plain_value(value: Any) -> Any:
    """Return a field's value, other than a message, in types that JSON has: an octet becomes a number."""
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if is_array(value):
        return [plain_value(item) for item in value]
    return value.item() if hasattr(value, "item") else value


def to_plain(message: Any) -> dict[str, Any]:
    """Return a message as a dict of its fields; nested messages become dicts, arrays become lists.

    Strings are cut at `MAX_CHARACTERS`, and arrays once the whole message has more than `MAX_ELEMENTS` elements.
    """
    return to_plain_and_size(message)[0]


def to_plain_and_size(message: Any) -> tuple[dict[str, Any], int]:
    """Return a message as `to_plain` does, and its memory cost in bytes. What is cut off counts in part."""
    converter = _Converter()
    plain = converter.convert(message)
    return plain, converter.bytes


def truncate(text: str, max_length: int = MAX_CHARACTERS) -> str:
    """Return the text, cut at `max_length` characters with an ellipsis."""
    return text if len(text) <= max_length else f"{text[: max_length - 3]}..."


def kept_bytes(text: str, kept: str) -> int:
    """Return the memory cost in bytes of the kept part of a text. What is cut off counts in part."""
    return _ELEMENT_BYTES + text_bytes(kept) + len(text) // RECEIVED_PER_KEPT_BYTE


def text_bytes(text: str) -> int:
    """Return about how many bytes a text takes in memory, apart from its header."""
    return len(text) * (1 if text.isascii() else 4)


def placeholder_message(message_type: Any, text: str) -> Any:
    """Return a stand-in for a message that cannot be decoded: `text` in its string fields, defaults elsewhere."""
    message = message_type()
    for name, type_name in message.get_fields_and_field_types().items():
        if type_name == "string":
            setattr(message, name, text)
    return message


class _Converter:
    """Converts one message to plain data within the limits, and adds up the memory cost."""

    def __init__(self) -> None:
        self.bytes = 0
        self._elements = MAX_ELEMENTS

    def convert(self, message: Any) -> dict[str, Any]:
        return {name: self._plain(getattr(message, name)) for name in message.get_fields_and_field_types()}

    def _plain(self, value: Any) -> Any:
        if is_message(value):
            return self.convert(value)
        if isinstance(value, str):
            kept = truncate(value)
            self.bytes += kept_bytes(value, kept)
            return kept
        if isinstance(value, bytes) or is_array(value):
            kept = value[: self._elements]
            self._elements -= len(kept)
            self.bytes += _ELEMENT_BYTES * len(kept) + len(value) // RECEIVED_PER_KEPT_BYTE
            return [self._plain(item) for item in kept]
        self.bytes += _ELEMENT_BYTES
        return plain_value(value)
