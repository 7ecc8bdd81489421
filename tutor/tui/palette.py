"""The command palette: every action, every lesson to go to, and every line of the lessons."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import cast

from textual.command import DiscoveryHit, Hit, Hits, Provider
from textual.content import Content

from tutor.content import Lesson
from tutor.tui import wording
from tutor.tui.commands import all_commands
from tutor.tui.control.host import HostScreen

MOST_LINES = 12
"""This many lines of the lessons are shown for one search."""

SHORTEST = 3
"""Fewer letters than this are found everywhere."""


class Actions(Provider):
    """What can be done now, and the lessons."""

    def _offers(self) -> Iterator[tuple[str, str, Callable[[], object]]]:
        screen = cast(HostScreen, self.screen)
        for command in all_commands():
            if screen.can(command):
                about = f"Key {' or '.join(command.shown_keys)}"
                yield command.text, about, partial(screen.do, command)
        for lesson in screen.model.session.lessons:
            name = f"Go to {wording.label(lesson)} {lesson.title}"
            yield name, f"{lesson.unit}, {lesson.difficulty}", partial(screen.go_to, lesson)

    async def discover(self) -> Hits:
        """What is offered before anything is typed."""
        for name, about, run in self._offers():
            yield DiscoveryHit(Content(name), run, text=name, help=_help(about))

    async def search(self, query: str) -> Hits:
        """What has each of the typed words in its name."""
        wanted = query.casefold().split()
        for name, about, run in self._offers():
            if all(word in name.casefold() for word in wanted):
                shown = Content(name)
                for word in wanted:
                    shown = shown.highlight_regex(_plain(word), style="bold $accent")
                yield Hit(0.9, shown, run, help=_help(about), text=name)


class LessonText(Provider):
    """Finds a text in the lessons, and goes there."""

    async def search(self, query: str) -> Hits:
        """The lines that hold the typed text, the shown lesson's first."""
        screen = cast(HostScreen, self.screen)
        here = screen.model.lesson
        for number, (lesson, line, text) in enumerate(found(screen.model.session.lessons, query, here)):
            if number >= MOST_LINES:
                return
            shown = Content.assemble(text).highlight_regex(_plain(query), style="bold $accent")
            about = f"{wording.label(lesson)} {lesson.title}, line {line + 1}"
            yield Hit(0.7 - number / 100, shown, partial(screen.go_to_line, lesson, line), text=text, help=_help(about))


def found(lessons: tuple[Lesson, ...], query: str, first: Lesson) -> Iterator[tuple[Lesson, int, str]]:
    """The lessons' lines that hold `query`, in any case: lesson, line number in its body from 0, the line's text."""
    wanted = query.strip().casefold()
    if len(wanted) < SHORTEST:
        return
    for lesson in sorted(lessons, key=lambda each: each is not first):
        for number, line in enumerate(lesson.body.splitlines()):
            if wanted in line.casefold():
                yield lesson, number, line.strip().lstrip("#>*- ").strip("`") or line.strip()


def _plain(query: str) -> str:
    return f"(?i){re.escape(query.strip())}"


def _help(text: str) -> str:
    """As the palette takes it: as markup."""
    return text.replace("[", r"\[")
