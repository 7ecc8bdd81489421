"""The YAML of messages that have nothing in them that YAML needs to escape: most messages of most topics.

PyYAML takes a fifth of a millisecond for each; at 1 kHz that is a fifth of a core. What is written here is what PyYAML
writes, character by character; whatever is not plainly so is left to it.
"""

from __future__ import annotations

import array
import re
from typing import Any

# A word or words that YAML takes for text in any place, and a text that it puts between single quotes in any place.
_PLAIN = re.compile(r"[A-Za-z](?:[A-Za-z0-9_/.-]| (?=[A-Za-z0-9_/.]))*\Z")
_QUOTED = re.compile(r"(?=.*: )[!-~](?:[ -~]*[!-~])?\Z")
_WORDS = frozenset(["yes", "no", "true", "false", "on", "off", "null"])


def dump_plain(message: Any, longest: int | None) -> str | None:
    """The message in block style, arrays and texts no longer than `longest`; None where that is for PyYAML to say."""
    lines: list[str] = []
    return "".join(lines) if _write(message, "", longest, lines) else None


def is_array(value: Any) -> bool:
    """Whether a field's value is an array or a sequence, in whichever of the forms that rclpy gives them."""
    return isinstance(value, (list, tuple, array.array)) or (hasattr(value, "tolist") and hasattr(value, "__len__"))


def _write(message: Any, indent: str, longest: int | None, lines: list[str]) -> bool:
    names = message.get_fields_and_field_types()
    for name in names:
        value = getattr(message, name)
        if name in _WORDS:
            return False
        if (written := _scalar(value, longest)) is not None:
            lines.append(f"{indent}{name}: {written}\n")
        elif hasattr(value, "get_fields_and_field_types"):
            lines.append(f"{indent}{name}:\n")
            if not _write(value, f"{indent}  ", longest, lines):
                return False
        elif not is_array(value) or not _write_array(name, value, indent, longest, lines):
            return False
    return bool(names)


def _write_array(name: str, values: Any, indent: str, longest: int | None, lines: list[str]) -> bool:
    if not len(values):
        lines.append(f"{indent}{name}: []\n")
        return True
    shown = values[:longest]
    written = [_scalar(value, longest) for value in (shown.tolist() if hasattr(shown, "tolist") else shown)]
    if None in written:
        return False
    lines.append(f"{indent}{name}:\n")
    lines += [f"{indent}- {each}\n" for each in written]
    if len(shown) < len(values):
        lines.append(f"{indent}- '...'\n")
    return True


def _scalar(value: Any, longest: int | None) -> str | None:
    kind = type(value)
    if kind is str:
        if longest is not None and len(value) > longest:
            return None
        if _PLAIN.match(value):
            return None if value.lower() in _WORDS else str(value)
        return "'" + value.replace("'", "''") + "'" if _QUOTED.match(value) else None
    if kind is float:
        return _float(value)
    if kind is int:
        return str(value)
    return ("true" if value else "false") if kind is bool else None


def _float(value: float) -> str:
    if value != value:
        return ".nan"
    if value in (float("inf"), float("-inf")):
        return ".inf" if value > 0 else "-.inf"
    text = repr(value)
    return text.replace("e", ".0e", 1) if "e" in text and "." not in text else text
