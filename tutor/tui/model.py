"""What is going on in the app: which lesson and file, what is known of them, and what is to be remembered."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.session import Session
from tutor.session.findings import Findings
from tutor.workspace import AppState, Progress, RunOptions


@dataclass
class AppModel:
    """Shared by the screen and its controllers; only they change it, in the app's own thread."""

    session: Session
    lesson: Lesson
    state: AppState = field(default_factory=AppState)
    file_index: int = 0
    progress: Progress = field(default_factory=Progress)
    findings: dict[str, Findings] = field(default_factory=dict)

    @classmethod
    def of(cls, session: Session, state: AppState) -> AppModel:
        """What the app begins with: where the learner left it."""
        known = {lesson.id: lesson for lesson in session.lessons}
        model = cls(session, known.get(state.lesson, session.lessons[0]), state)
        model.findings = {lesson.id: Findings.of(lesson) for lesson in session.lessons}
        return model

    @property
    def file(self) -> LessonFile:
        """The lesson's file that is shown."""
        return self.lesson.files[self.file_index]

    @property
    def path(self) -> Path:
        """Where that file is."""
        return self.session.path(self.file)

    @property
    def paths(self) -> list[Path]:
        """Where the lesson's files are."""
        return [self.session.path(file) for file in self.lesson.files]

    @property
    def run_options(self) -> RunOptions:
        """How the lesson's node is to be run."""
        return self.state.run_of(self.lesson.id)
