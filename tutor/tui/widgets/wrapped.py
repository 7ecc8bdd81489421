"""Text that is wrapped between words, and a line of code between its names, never within one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Self

from rich.cells import cell_len
from textual.content import Content
from textual.geometry import Size
from textual.selection import Selection
from textual.widgets import Static

_BREAK_AFTER = "([{,;:=/|&+"


class WrappedText(Static):
    """Wraps as `wrap` does. Selected text is copied as it was before."""

    DEFAULT_CSS = "WrappedText { text-wrap: nowrap; }"

    def __init__(self, id: str | None = None, classes: str | None = None, *, hang: int = 0) -> None:
        super().__init__(id=id, classes=classes, markup=False)
        self._hang = hang

    def with_text(self, text: Content) -> Self:
        """Show this text; return the widget."""
        self.update(text)
        return self

    @property
    def text(self) -> Content:
        """The text before it is wrapped."""
        return self.content if isinstance(self.content, Content) else Content(str(self.content))

    @property
    def heights(self) -> list[int]:
        """How many rows each line of the text has, at the widget's width."""
        width = self.content_size.width
        return [len(list(wrap(line, width, self._hang))) for line in self.text.split("\n", allow_blank=True)]

    def render(self) -> Content:
        """Return the text, wrapped to the widget's width."""
        return Content("\n").join(row for row, _ in self._rows(self.content_size.width))

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        """Return the number of rows at this width."""
        return sum(1 for _ in self._rows(width))

    def get_selection(self, selection: Selection) -> tuple[str, str] | None:
        """Return the selected text, without the line breaks that wrapping has added."""
        rows = list(self._rows(self.content_size.width))
        parts: list[str] = []
        for y, (row, joint) in enumerate(rows):
            if (span := selection.get_span(y)) is not None:
                start, end = span
                whole = end == -1 or end >= len(row.plain)
                parts += [row.plain[start : None if end == -1 else end], joint if whole else ""]
        return "".join(parts).removesuffix("\n"), "\n"

    def _rows(self, width: int) -> Iterator[tuple[Content, str]]:
        """Yield each row, and what was between it and the next one."""
        for line in self.text.split("\n", allow_blank=True):
            yield from wrap(line, width, self._hang)


def wrap(line: Content, width: int, hang: int = 0) -> Iterator[tuple[Content, str]]:
    """Yield the rows of a line, and what was between each and the next: a space, nothing, or finally a line break.

    Further rows are indented as the line is, and by `hang` cells more. Only a name that is longer than a row is broken.
    """
    plain = line.plain
    indent = min(len(plain) - len(plain.lstrip(" ")) + hang, max(0, width // 3))
    start, margin = 0, ""
    while True:
        room = max(1, width - len(margin))
        end = start + _fitting(plain[start:], room)
        if end >= len(plain):
            yield Content(margin) + line[start:], "\n"
            return
        cut = _cut(plain, start, end, width - indent)
        after = cut + len(plain[cut:]) - len(plain[cut:].lstrip(" "))
        yield Content(margin) + line[start:cut], plain[cut:after]
        start, margin = after, " " * indent
        if start >= len(plain):
            return


def _fitting(text: str, room: int) -> int:
    """Return how many characters fit into this many cells; at least one."""
    if text.isascii():
        return max(1, min(len(text), room))
    used = 0
    for count, character in enumerate(text):
        used += cell_len(character)
        if used > room:
            return max(1, count)
    return len(text)


def _cut(text: str, start: int, end: int, next_room: int) -> int:
    """Return where to cut `text[start:]`, of which `text[start:end]` fits into the row."""
    first = start + len(text[start:]) - len(text[start:].lstrip(" "))
    space = text.rfind(" ", first + 1, end + 1)
    word = text[space + 1 :].partition(" ")[0] if space > 0 else text[first:]
    if space > 0 and len(word) <= next_room:
        return space
    places = [n for n in range(max(first, space) + 1, end + 1) if n < len(text) and _is_boundary(text, n)]
    best = [n for n in places if text[n - 1] in _BREAK_AFTER or text[n] == "."]
    for found in (best, places):
        if found:
            return found[-1]
    return space if space > 0 else end


def _is_boundary(text: str, place: int) -> bool:
    """Return whether no name goes on across this place."""
    return not (_is_of_a_name(text[place - 1]) and _is_of_a_name(text[place]))


def _is_of_a_name(character: str) -> bool:
    return character.isalnum() or character == "_"
