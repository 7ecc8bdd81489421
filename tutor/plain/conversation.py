"""Where the learner is in the course, and the two ways to talk with them."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass, replace

from tutor.content import Lesson
from tutor.errors import CommandRefused, StorageError, UnknownExercise
from tutor.session import Session
from tutor.workspace import Progress, State


@dataclass(frozen=True, slots=True)
class DialogCommand:
    """A thing to do: its name (and others that are understood), what may follow it, and what it does, in words."""

    name: str
    text: str
    do: Callable[[list[str]], Awaitable[None]]
    follows: str = ""
    others: tuple[str, ...] = ()


class Conversation:
    """The lesson that the learner is at; `say` tells a line, `ask` a question, whose answer is None at the end."""

    def __init__(
        self, session: Session, say: Callable[[str], None], ask: Callable[[str], Awaitable[str | None]]
    ) -> None:
        self.session, self.say, self.ask = session, say, ask
        session.notify = say
        self.lesson = self._first()

    def _first(self) -> Lesson:
        """Where the learner was last; else the first lesson that is not passed."""
        lessons = self.session.lessons
        remembered = {lesson.id: lesson for lesson in lessons}.get(self.session.app_state().lesson)
        if remembered is not None:
            return remembered
        progress = self.session.progress()
        left = [lesson for lesson in lessons if not progress.of(lesson.id).is_passed]
        return (left or [*lessons])[0]

    def open_lesson(self, lesson: Lesson) -> None:
        """Be at this lesson, and say so. The app, too, opens there the next time."""
        self.lesson = lesson
        self.say(f"You are at {self.about(lesson, self.session.progress())}")
        try:
            self.session.keep(replace(self.session.app_state(), lesson=lesson.id))
        except StorageError as error:
            self.say(f"This place is not remembered: {error}")

    def about(self, lesson: Lesson, progress: Progress) -> str:
        """A lesson in a line: its id, title and difficulty, and how it stands."""
        return f"{lesson.id} {lesson.title}, {lesson.difficulty.value}, {self.state_words(lesson, progress)}."

    def state_words(self, lesson: Lesson, progress: Progress) -> str:
        """How far the learner is with a lesson."""
        found = self.session.states(progress)[lesson.id]
        return {
            State.PASSED: "passed",
            State.NOT_PASSED: f"not passed yet, {found.count} criteria met",
            State.STARTED: "started",
            State.NOT_STARTED: "not started",
        }[found.state]

    def find(self, text: str) -> Lesson:
        """A lesson by its number in the list, or by its id. Raises Refused."""
        lessons = self.session.lessons
        if text.isdecimal():
            if 1 <= int(text) <= len(lessons):
                return lessons[int(text) - 1]
            raise CommandRefused(f"There is no lesson {text}: they go from 1 to {len(lessons)}.")
        try:
            return self.session.course.find(text)
        except UnknownExercise as error:
            raise CommandRefused(str(error)) from error
