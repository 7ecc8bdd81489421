"""The first paint: drawn at once, before the widgets, the editor and the Markdown are loaded."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.content import Content
from textual.screen import Screen
from textual.widgets import Static

from tutor.content import Lesson
from tutor.tui import wording


class OpeningScreen(Screen[None]):
    """The bar at the top as the main screen has it, and what is being opened."""

    CSS = """
    OpeningScreen {
        background: $background;
        & > #opening-bar { height: 1; background: $panel; }
        & > #opening-text { height: 1fr; content-align: center middle; color: $quiet; }
    }
    """

    def __init__(self, lesson: Lesson | None) -> None:
        """`lesson` is the one that will be opened; None before the first start."""
        super().__init__()
        self._lesson = lesson

    def compose(self) -> ComposeResult:
        name = Content.styled(" ROS Tutor ", "bold $background on $primary")
        if (lesson := self._lesson) is None:
            yield Static(name, id="opening-bar")
            return
        title = Content.assemble((f" {wording.label(lesson)}", "bold"), f" {lesson.title}")
        level = Content.styled(f"  {wording.LEVELS[lesson.difficulty]}", "$quiet")
        yield Static(Content.assemble(name, title, level), id="opening-bar")
        yield Static(f"Opening {wording.label(lesson)} {lesson.title} …", id="opening-text", markup=False)
