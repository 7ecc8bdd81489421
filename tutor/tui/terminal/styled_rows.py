"""Rows of an emulator as Textual draws them: text with SGR sequences becomes styled segments."""

from __future__ import annotations

import re
from functools import lru_cache

from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

from tutor.terminal_text import strip_controls

_SGR = re.compile(r"\x1b\[([\d;:]*)m")
_JOINED = re.compile("[\u200b-\u200f\u2060-\u2064\ufe00-\ufe0f]|([\U0001f1e6-\U0001f1ff\U0001f3fb-\U0001f3ff])")
"""Characters that make one picture of several: the emulator counts the cells of each, Rich those of the whole."""

_ATTRIBUTES = {
    "1": Style(bold=True),
    "2": Style(dim=True),
    "3": Style(italic=True),
    "7": Style(reverse=True),
    "8": Style(conceal=True),
    "9": Style(strike=True),
    "53": Style(overline=True),
}
"""Blinking text (5) does not blink here."""


def styled_row(text: str, width: int, base: Style) -> Strip:
    """Return a row as a strip of this width, in cells, in which `base` is what the program leaves open."""
    plain = text.isascii()
    if plain and "\x1b" not in text:
        return Strip([Segment(strip_controls(text).ljust(width)[:width], base)], width)
    if not plain:
        text = _JOINED.sub(_separate, text)
    segments, style = [], base
    parts = _SGR.split(text)
    for index in range(0, len(parts), 2):
        if index:
            style = base if parts[index - 1] in ("", "0") else style + _style(parts[index - 1])
        if parts[index]:
            segments.append(Segment(strip_controls(parts[index]), style))
    cells = sum(len(segment.text) for segment in segments) if plain else None  # measuring takes longer than the rest
    return Strip(segments, cells).adjust_cell_length(width, base)


def _separate(match: re.Match[str]) -> str:
    """Return what stands for a character that would join its neighbours, as wide as the emulator counts it."""
    character = match[1] or ""
    if "\U0001f1e6" <= character <= "\U0001f1ff":  # half of a flag
        return chr(ord(character) - 0x1F1E6 + ord("A")) + " "
    return "  " if character else ""


@lru_cache(maxsize=4096)
def _style(codes: str) -> Style:
    """Return the style of one SGR sequence as the emulator writes it: one attribute each."""
    if codes in _ATTRIBUTES:
        return _ATTRIBUTES[codes]
    if codes == "4" or (codes.startswith("4:") and codes != "4:0"):
        return Style(underline=True)
    kind, _, rest = codes.replace(":", ";").partition(";")
    numbers = [int(number) for number in rest.split(";") if number]
    match numbers:
        case [5, number] if number < 256:
            color = Color.from_ansi(number)
        case [2, red, green, blue] if max(numbers) < 256:
            color = Color.from_rgb(red, green, blue)
        case _:
            return Style.null()
    return {"38": Style(color=color), "48": Style(bgcolor=color)}.get(kind, Style.null())
