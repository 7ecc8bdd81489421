"""Goes from lesson to lesson."""

from __future__ import annotations

from functools import partial

from tutor.content import Lesson
from tutor.tui import commands
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.pages import Pages
from tutor.tui.control.preferences import Preferences
from tutor.tui.control.standing import Standing
from tutor.tui.widgets.lesson_list import LessonList
from tutor.tui.widgets.lesson_view import LessonView
from tutor.tui.widgets.status_bar import StatusBar


class Lessons:
    """Shows a lesson everywhere: its text, files, criteria, and what it is about on the live page."""

    def __init__(
        self, host: HostScreen, pages: Pages, files: Files, preferences: Preferences, standing: Standing
    ) -> None:
        self._host, self._pages, self._files = host, pages, files
        self._preferences, self._standing = preferences, standing
        host.register(commands.NEXT, partial(self.step, 1))
        host.register(commands.PREVIOUS, partial(self.step, -1))

    async def go_to(self, lesson: Lesson, page: str = "lesson") -> None:
        """Go to a lesson, and show the given page of it."""
        host = self._host
        host.model.lesson = lesson
        self._preferences.update(lesson=lesson.id)
        host.query_one(StatusBar).show_lesson(lesson)
        host.query_one(LessonList).show_lesson(lesson)
        host.remove_class("-drawer")
        self._files.show(0)
        host.show_page(page)
        if (live := self._pages.live) is not None:
            live.set_lesson(lesson)
        await self._standing.show_lesson(lesson)
        await host.query_one(LessonView).show_lesson(lesson)
        host.refresh_bindings()

    async def go_to_line(self, lesson: Lesson, line: int) -> None:
        """Go to a line (from 0) of a lesson's text."""
        await self.go_to(lesson)
        view = self._host.query_one(LessonView)
        view.call_after_refresh(view.go_to_line, line)

    async def step(self, by: int) -> None:
        """Go to the next lesson, or with a negative `by` to the previous one."""
        lessons = self._host.model.session.lessons
        place = lessons.index(self._host.model.lesson) + by
        if 0 <= place < len(lessons):
            await self.go_to(lessons[place])
        else:
            self._host.say("This is the last lesson." if by > 0 else "This is the first lesson.")
