"""What was handed over to the learner: the skeleton, or a system with a fault that was drawn for them."""

from __future__ import annotations

from collections.abc import Callable

from tutor.content import Lesson, LessonFile
from tutor.content.cases import Report
from tutor.errors import StorageError
from tutor.workspace import Workspace
from tutor.workspace.answering import Question, answer, ask
from tutor.workspace.drawn_cases import Drawn, skeleton_text, solution_text


class HandedOver:
    """The part of a session that knows the case. `workspace` and `notify`: the session's own, as they are now."""

    def __init__(self, workspace: Callable[[], Workspace], notify: Callable[[str], None]) -> None:
        self._workspace, self._notify = workspace, notify

    def drawn(self, lesson: Lesson) -> Drawn:
        """Return which faults were drawn, of a lesson that hands over a system. Raises StorageError."""
        workspace = self._workspace()
        return workspace.cases(self._notify).read(lesson.id) if workspace.exists else Drawn()

    def skeleton(self, lesson: Lesson, file: LessonFile) -> str:
        """Return a file as it was handed over. Raises StorageError."""
        return self._read(skeleton_text, lesson, file)

    def solution(self, lesson: Lesson, file: LessonFile) -> str:
        """Return our solution's file. Raises StorageError."""
        return self._read(solution_text, lesson, file)

    def _read(self, read: Callable[[Lesson, LessonFile, Drawn], str], lesson: Lesson, file: LessonFile) -> str:
        try:
            return read(lesson, file, self.drawn(lesson))
        except OSError as error:
            raise StorageError.of(f"read {file.name}", error) from error

    def question(self, lesson: Lesson) -> Question:
        """Return what the learner has to answer. Raises UsageError where there is nothing, and StorageError."""
        return ask(lesson, self._workspace())

    def answer(self, lesson: Lesson, what: str, where: str) -> Report:
        """Write the learner's answer into the report, and return it. Raises UsageError or StorageError."""
        return answer(lesson, self._workspace(), what, where)
