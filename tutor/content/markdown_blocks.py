"""The blocks of a lesson's Markdown: headings, paragraphs, items, code and tables, without their markup."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tutor.content.plain_text import without_markup

_HEADING = re.compile(r"(#+)\s+(.*)")
_ITEM = re.compile(r"\s*(?:[-*+]|\d+\.)\s")
_RULE = re.compile(r"\|(?:\s*:?-+:?\s*\|)+")
"""The line below the heading of a table."""

_CELL_BORDER = re.compile(r"(?<!\\)\|")


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading; `level` is the number of its marks."""

    text: str
    level: int


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph on one line."""

    text: str


@dataclass(frozen=True, slots=True)
class Item:
    """An item of a list on one line, with its `- ` or number."""

    text: str


@dataclass(frozen=True, slots=True)
class Code:
    """The lines of a block of code, as they are."""

    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """A table: what its columns are called, and its rows, each with as many cells as there are columns."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def spoken_rows(self) -> Iterator[str]:
        """Yield each row on one line that needs no other: "topic: /map; type: std_msgs/msg/String"."""
        for row in self.rows:
            named = zip(self.columns, row, strict=True)
            yield "; ".join(_with_name(column, cell) for column, cell in named if cell)


Block = Heading | Paragraph | Item | Code | Table


def blocks(markdown: str) -> Iterator[Block]:
    """Yield the blocks of a lesson."""
    prose: list[str] = []
    code: list[str] | None = None
    for line in markdown.splitlines():
        fence = line.lstrip().startswith("```")
        if code is not None:
            if fence:
                yield Code(tuple(code))
                code = None
            else:
                code.append(line)
            continue
        heading = _HEADING.fullmatch(line)
        if prose and (fence or heading or not line.strip() or _ITEM.match(line) or _begins_or_ends_table(prose, line)):
            yield _block_of(prose)
            prose = []
        if fence:
            code = []
        elif heading:
            yield Heading(without_markup(heading[2]), len(heading[1]))
        elif line.strip():
            prose.append(line)
    if prose:
        yield _block_of(prose)
    if code is not None:
        yield Code(tuple(code))


def _begins_or_ends_table(before: Sequence[str], line: str) -> bool:
    return before[-1].lstrip().startswith("|") is not line.lstrip().startswith("|")


def _block_of(lines: Sequence[str]) -> Block:
    if len(lines) > 1 and lines[0].lstrip().startswith("|") and _RULE.fullmatch(lines[1].strip()):
        columns = _cells(lines[0])
        padding = ("",) * len(columns)
        return Table(columns, tuple((*_cells(line), *padding)[: len(columns)] for line in lines[2:]))
    text = without_markup(" ".join(line.strip() for line in lines))
    return Item(text) if _ITEM.match(lines[0]) else Paragraph(text)


def _cells(line: str) -> tuple[str, ...]:
    inner = line.strip().removeprefix("|").removesuffix("|")
    return tuple(without_markup(cell.strip().replace("\\|", "|")) for cell in _CELL_BORDER.split(inner))


def _with_name(column: str, cell: str) -> str:
    if not column:
        return cell
    return f"{column} {cell}" if column.endswith("?") else f"{column}: {cell}"
