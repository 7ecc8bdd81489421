"""The first paint: drawn at once, before the modules of widgets, editor and Markdown are imported."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.content import Content
from textual.screen import Screen
from textual.widgets import Static

from tutor.content import Lesson
from tutor.tui import wording


class OpeningScreen(Screen[None]):
    """The top bar, as on the main screen, and the name of the lesson being opened."""

    CSS = """
    OpeningScreen {
        background: $background;
        & > #opening-bar { height: 1; background: $panel; }
        & > #opening-text { height: 1fr; content-align: center middle; color: $quiet; }
    }
    """

    def __init__(self, lesson: Lesson | None) -> None:
        """`lesson` is the one being opened; None if there is no workspace yet."""
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
