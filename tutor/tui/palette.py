"""The command palette: all available actions, all lessons, and full-text search in the lessons."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import cast

from textual.command import DiscoveryHit, Hit, Hits, Provider
from textual.content import Content

from tutor.content import Lesson
from tutor.content.plain_text import plain_lines
from tutor.tui import wording
from tutor.tui.commands import all_commands
from tutor.tui.control.host import HostScreen

MAX_LINES = 12
"""Maximum number of lesson lines shown for one query."""

MIN_QUERY_LENGTH = 3
"""Minimum query length for searching the lessons: anything shorter matches almost everywhere."""


class Actions(Provider):
    """Offers the commands that are available now, and the lessons to go to."""

    def _entries(self) -> Iterator[tuple[str, str, Callable[[], object]]]:
        screen = cast(HostScreen, self.screen)
        for command in all_commands():
            if screen.can(command):
                about = f"Key {' or '.join(command.shown_keys)}"
                yield command.text, about, partial(screen.do, command)
        for lesson in screen.model.session.lessons:
            name = f"Go to {wording.label(lesson)} {lesson.title}"
            yield name, f"{lesson.unit}, {lesson.difficulty}", partial(screen.go_to, lesson)

    async def discover(self) -> Hits:
        """Yield everything, while nothing has been typed yet."""
        for name, about, run in self._entries():
            yield DiscoveryHit(Content(name), run, text=name, help=_escape(about))

    async def search(self, query: str) -> Hits:
        """Yield the entries whose names contain every typed word."""
        wanted = query.casefold().split()
        for name, about, run in self._entries():
            if all(word in name.casefold() for word in wanted):
                shown = Content(name)
                for word in wanted:
                    shown = shown.highlight_regex(_literal_pattern(word), style="bold $accent")
                yield Hit(0.9, shown, run, help=_escape(about), text=name)


class LessonText(Provider):
    """Searches the lessons' text, and goes to the line chosen."""

    async def search(self, query: str) -> Hits:
        """Yield the lines that contain the typed text, those of the lesson shown first."""
        screen = cast(HostScreen, self.screen)
        here = screen.model.lesson
        for rank, (lesson, line, text) in enumerate(_find_lines(screen.model.session.lessons, query, here)):
            if rank >= MAX_LINES:
                return
            shown = Content.assemble(text).highlight_regex(_literal_pattern(query), style="bold $accent")
            about = f"{wording.label(lesson)} {lesson.title}, line {line + 1}"
            yield Hit(0.7 - rank / 100, shown, partial(screen.go_to_line, lesson, line), text=text, help=_escape(about))


def _find_lines(lessons: tuple[Lesson, ...], query: str, first: Lesson) -> Iterator[tuple[Lesson, int, str]]:
    """Yield the lines that contain `query`, ignoring case, as (lesson, line number in its body from 0, plain text).

    Those of the lesson `first` come first.
    """
    wanted = query.strip().casefold()
    if len(wanted) < MIN_QUERY_LENGTH:
        return
    for lesson in sorted(lessons, key=lambda lesson: lesson is not first):
        for number, text in plain_lines(lesson.body):
            if wanted in text.casefold():
                yield lesson, number, text


def _literal_pattern(query: str) -> str:
    return f"(?i){re.escape(query.strip())}"


def _escape(text: str) -> str:
    """Escape a help text: the palette parses it as markup."""
    return text.replace("[", r"\[")
