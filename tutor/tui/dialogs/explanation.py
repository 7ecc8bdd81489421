"""Shows the page of a mistake: what happens and why, a bad and a good example, how to see it, where it is taught."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widget import Widget
from textual.widgets import Static

from tutor.invocation import with_program_name
from tutor.mistakes import Mistake
from tutor.mistakes.pages import Section, sections_of
from tutor.tui.dialogs.dialog import Dialog
from tutor.tui.widgets.code_view import highlight
from tutor.tui.widgets.wrapped import WrappedText

_COLOURS = {kind: f"$code-{kind}" for kind in ("keyword", "string", "number", "comment", "name", "type")}
_EXAMPLES = {"Bad": ("✗", "$bad"), "Good": ("✓", "$good")}
_QUOTED = re.compile(r"`([^`]+)`")


class ExplanationScreen(Dialog[None]):
    """The pages of mistakes, one at a time. `note`, if any, says above them why they were opened."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("x", "next", "Next", show=False),
        Binding("enter,q", "close", show=False),
    ]

    def __init__(self, mistakes: Sequence[Mistake], note: str = "") -> None:
        super().__init__()
        self._mistakes, self._note = mistakes, note
        self._index = 0

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="window", id="explanation"):
            yield from self._page()

    def on_mount(self) -> None:
        self._show_titles()

    async def action_next(self) -> None:
        """Show the next page, or close after the last."""
        if self._index + 1 == len(self._mistakes):
            self.dismiss(None)
            return
        self._index += 1
        window = self.query_one("#explanation")
        await window.remove_children()
        await window.mount_all(self._page())
        window.scroll_home(animate=False)
        self._show_titles()

    def _show_titles(self) -> None:
        window, count = self.query_one("#explanation"), len(self._mistakes)
        place = f" ({self._index + 1} of {count})" if count > 1 else ""
        more = "x: the other one · " if self._index + 1 < count else ""
        window.border_title = Content(f"{self._mistakes[self._index].title}{place}")
        window.border_subtitle = f"↑↓ scroll · {more}Esc closes"

    def _page(self) -> Iterator[Widget]:
        mistake = self._mistakes[self._index]
        if self._note and not self._index:
            yield WrappedText(classes="explanation-note").with_text(Content(self._note))
        yield _paragraph(mistake.summary, "explanation-summary")
        sections = list(sections_of(mistake))
        for place, section in enumerate(sections):
            if section.code:
                yield Static(_example_heading(section.heading), classes="explanation-heading")
                yield _example(section, sections)
            elif section.heading:
                first = place == 0 or sections[place - 1].heading != section.heading
                text = Content.assemble(
                    (f"{section.heading}  " if first else "", "bold $accent"), _quoted(section.text)
                )
                yield WrappedText(classes="explanation-text", hang=2).with_text(text)
            else:
                yield _paragraph(section.text, "explanation-text")


def _paragraph(text: str, classes: str) -> WrappedText:
    return WrappedText(classes=classes).with_text(_quoted(text))


def _example_heading(heading: str) -> Content:
    mark, colour = _EXAMPLES.get(heading, ("", "$accent"))
    return Content.styled(f"{mark} {heading}".strip(), f"bold {colour}")


def _example(section: Section, sections: Sequence[Section]) -> WrappedText:
    """An example, with a mark beside the lines that are not in the other one."""
    others = [other.text for other in sections if other.code and other.heading != section.heading]
    changed = _lines_only_in(section.text, others[0]) if others else set()
    colour = _EXAMPLES.get(section.heading, ("", "$accent"))[1]
    lines = [
        Content.assemble(
            ("▌ " if number in changed else "  ", colour),
            *((text, _COLOURS.get(kind, "$foreground")) for text, kind in row),
        )
        for number, row in enumerate(highlight(section.text))
    ]
    return WrappedText(classes="explanation-code", hang=4).with_text(Content("\n").join(lines))


def _lines_only_in(text: str, other: str) -> set[int]:
    lines = text.splitlines()
    same = difflib.SequenceMatcher(None, lines, other.splitlines(), autojunk=False).get_matching_blocks()
    common = {block.a + step for block in same for step in range(block.size)}
    return {number for number, line in enumerate(lines) if number not in common and line.strip()}


def _quoted(text: str) -> Content:
    """Return the text, with what stands between backticks in the colour of code."""
    parts: list[Content | str | tuple[str, str]] = []
    for place, part in enumerate(_QUOTED.split(with_program_name(text))):
        parts.append((part, "$secondary") if place % 2 else part)
    return Content.assemble(*parts)
