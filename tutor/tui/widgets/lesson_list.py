"""The list of lessons at the left, each with its difficulty and the learner's progress."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from textwrap import wrap

from textual.content import Content
from textual.geometry import Size
from textual.widgets import ListItem

from tutor.content import Counts, Lesson
from tutor.tui import wording
from tutor.tui.widgets.row_list import RowList
from tutor.workspace import ExerciseProgress, ExerciseState, exercise_state

_COLOURS = {"✓": "$good", "◐": "$warn", "○": "$quiet"}


class UnitRow(ListItem):
    """The name of a unit, above its lessons."""

    def __init__(self, unit: str) -> None:
        super().__init__(disabled=True)
        self.unit = unit

    def render(self) -> Content:
        """The full name, wrapped if need be."""
        return Content(self.unit)


class CourseRow(UnitRow):
    """The title of a course, above its units, where there are several courses."""


class LessonRow(ListItem):
    """One lesson: its wrapped title, and a line with difficulty and progress."""

    def __init__(self, lesson: Lesson) -> None:
        super().__init__()
        self.lesson = lesson
        self.state = exercise_state(lesson, ExerciseProgress())

    def _title(self, width: int) -> list[str]:
        return wrap(f"{wording.label(self.lesson)} {self.lesson.title}", max(10, width - 2))

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        """The lines of the title, plus one."""
        return len(self._title(width)) + 1

    def render(self) -> Content:
        """The mark and the title; below them difficulty and progress in words."""
        mark, words = wording.progress_label(self.state)
        width = self.content_size.width
        title = "\n  ".join(self._title(width))
        level = wording.LEVELS[self.lesson.difficulty]
        gap = " " * max(1, width - 2 - len(level) - len(words))
        colour = _COLOURS[mark]
        return Content.assemble((f"{mark} ", colour), title, "\n  ", (level, "$quiet"), gap, (words, colour))


class LessonList(RowList):
    """All lessons, grouped by course and unit."""

    DEFAULT_CSS = """
    LessonList {
        background: $surface;
        scrollbar-size: 1 1;
        & > ListItem { padding: 0 1; }
        & > LessonRow { height: auto; margin-bottom: 1; text-wrap: nowrap; }
        & > LessonRow.-shown { text-style: bold; }
        & > UnitRow { height: auto; color: $quiet; opacity: 100%; padding: 0 1 1 1; }
        & > CourseRow { color: $foreground; text-style: bold; }
        &:focus { background-tint: transparent 0%; }
    }
    """

    def __init__(self, lessons: Iterable[Lesson], id: str | None = None) -> None:
        rows: list[ListItem] = []
        unit = ""
        shown = list(lessons)
        headings = {lesson.heading for lesson in shown}
        heading = ""
        for lesson in shown:
            if len(headings) > 1 and lesson.heading != heading:
                heading, unit = lesson.heading, ""
                rows.append(CourseRow(heading))
            if lesson.unit != unit:
                unit = lesson.unit
                rows.append(UnitRow(unit))
            rows.append(LessonRow(lesson))
        super().__init__(*rows, id=id, initial_index=None)

    @property
    def lesson_rows(self) -> list[LessonRow]:
        """The rows of lessons, in order."""
        return list(self.query(LessonRow))

    def show_lesson(self, lesson: Lesson) -> None:
        """Mark the row of the lesson that is shown."""
        for index, row in enumerate(self.children):
            if isinstance(row, LessonRow):
                row.set_class(row.lesson is lesson, "-shown")
                if row.lesson is lesson:
                    self.index = index

    def show_states(self, states: Mapping[str, ExerciseState]) -> None:
        """Show the learner's progress in each lesson, given by lesson id."""
        for row in self.lesson_rows:
            row.state = states[row.lesson.id]
            row.refresh()
        rows = self.lesson_rows
        passed = [row.lesson.id for row in rows if row.state.is_passed]
        self.border_subtitle = str(Counts.of((row.lesson for row in rows), passed))
