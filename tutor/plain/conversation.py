"""The learner's place in the course, and how to talk with them."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass, replace

from tutor.content import Lesson
from tutor.errors import CommandRefused, StorageError, UnknownExercise
from tutor.session import Session
from tutor.workspace import Progress, State


@dataclass(frozen=True, slots=True)
class DialogCommand:
    """A command: `text` describes it, `arguments` names what may follow it, `aliases` are other names for it."""

    name: str
    text: str
    run: Callable[[list[str]], Awaitable[None]]
    arguments: str = ""
    aliases: tuple[str, ...] = ()


class Conversation:
    """The current lesson. `say` prints a line; `ask` prints a question and returns the answer, None at end of input."""

    def __init__(
        self, session: Session, say: Callable[[str], None], ask: Callable[[str], Awaitable[str | None]]
    ) -> None:
        self.session, self.say, self.ask = session, say, ask
        session.notify = say
        self.lesson = self._initial_lesson()

    def _initial_lesson(self) -> Lesson:
        """Return the lesson opened last, else the first one that is not passed."""
        lessons = self.session.lessons
        remembered = {lesson.id: lesson for lesson in lessons}.get(self.session.app_state().lesson)
        if remembered is not None:
            return remembered
        progress = self.session.progress()
        open_lessons = [lesson for lesson in lessons if not progress.of(lesson.id).is_passed]
        return (open_lessons or [*lessons])[0]

    def open_lesson(self, lesson: Lesson) -> None:
        """Go to a lesson, and say so. The app will open there next time, too."""
        self.lesson = lesson
        self.say(f"You are at {self.describe(lesson, self.session.progress())}")
        try:
            self.session.save_app_state(replace(self.session.app_state(), lesson=lesson.id))
        except StorageError as error:
            self.say(f"Your place could not be saved: {error}")

    def describe(self, lesson: Lesson, progress: Progress) -> str:
        """Return a lesson on one line: id, title, difficulty and progress."""
        return f"{lesson.id} {lesson.title}, {lesson.difficulty.value}, {self.describe_progress(lesson, progress)}."

    def describe_progress(self, lesson: Lesson, progress: Progress) -> str:
        """Return the learner's progress in a lesson, in words."""
        current = self.session.states(progress)[lesson.id]
        return {
            State.PASSED: "passed",
            State.NOT_PASSED: f"not passed yet, {current.count} criteria met",
            State.STARTED: "started",
            State.NOT_STARTED: "not started",
        }[current.state]

    def find_lesson(self, text: str) -> Lesson:
        """Return a lesson by its number in the list or its id. Raises CommandRefused."""
        lessons = self.session.lessons
        if text.isdecimal():
            if 1 <= int(text) <= len(lessons):
                return lessons[int(text) - 1]
            raise CommandRefused(f"There is no lesson {text}: they go from 1 to {len(lessons)}.")
        try:
            return self.session.course.find(text)
        except UnknownExercise as error:
            raise CommandRefused(str(error)) from error
