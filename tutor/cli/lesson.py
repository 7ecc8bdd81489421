"""`ros-tutor lesson`: print the text of an exercise."""

from __future__ import annotations

import argparse
import sys
import textwrap
from collections.abc import Iterator
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.invocation import with_program_name

if TYPE_CHECKING:
    from tutor.content.markdown_blocks import Block, Table

_GAP = "  "
"""What is between two columns of a table."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `EXERCISE`."""
    parser.add_argument("exercise", metavar="EXERCISE", help="for example i1.1")


def run(arguments: argparse.Namespace) -> int:
    """Print the lesson without its markup, wrapped to the terminal."""
    from tutor.content.markdown_blocks import Item, blocks

    lesson = context.load_course(arguments).find(arguments.exercise)
    columns = terminal.width(sys.stdout)
    heading = terminal.style(f"{lesson.id} {lesson.title} ({lesson.difficulty.value})", "1", sys.stdout)
    text = f"{heading}\n{terminal.wrap(' '.join(lesson.objective.split()), columns)}"
    before: Block | None = None
    for block in blocks(with_program_name(lesson.body)):
        gap = "" if isinstance(before, Item) and isinstance(block, Item) else "\n"
        text += gap + "".join(f"{line}\n" for line in _render(block, columns))
        before = block
    terminal.out(text)
    return PASSED


def _render(block: Block, columns: int) -> Iterator[str]:
    from tutor.content.markdown_blocks import Code, Heading, Item, Table

    match block:
        case Heading(text, level):
            yield terminal.style(text.upper() if level <= 2 else text, "1", sys.stdout)
        case Code(lines):
            yield from (f"    {line}".rstrip() for line in lines)
        case Table():
            yield from _render_table(block, columns)
        case Item(text):
            yield from _wrap(text, columns, hang=len(text) - len(text.lstrip().partition(" ")[2]))
        case _:
            yield from _wrap(block.text, columns)


def _render_table(table: Table, columns: int) -> Iterator[str]:
    """Yield its columns side by side; if they are too wide for that, each row with the names of its columns."""
    rows = (table.columns, *table.rows)
    widths = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
    if sum(widths) + len(_GAP) * len(widths) > columns:
        for row in table.spoken_rows():
            yield from _wrap(f"- {row}", columns, hang=2)
        return
    for cells in (table.columns, tuple("-" * width for width in widths), *table.rows):
        padded = _GAP.join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True))
        yield f"{_GAP}{padded}".rstrip()


def _wrap(text: str, columns: int, hang: int = 0) -> list[str]:
    """Wrap one line; the lines after the first are indented by `hang` columns."""
    return textwrap.wrap(text, columns, subsequent_indent=" " * hang, break_long_words=False, break_on_hyphens=False)
