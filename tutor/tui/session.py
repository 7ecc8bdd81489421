"""What is going on in the app: which lesson and file, what is known of them, and what is to be remembered."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.tui.app_services import AppServices
from tutor.tui.findings import Findings
from tutor.workspace import AppState, Progress, RunOptions


@dataclass
class Session:
    """Shared by the screen and its controllers; only they change it, in the app's own thread."""

    app_services: AppServices
    lesson: Lesson
    state: AppState = field(default_factory=AppState)
    file_index: int = 0
    progress: Progress = field(default_factory=Progress)
    findings: dict[str, Findings] = field(default_factory=dict)

    @classmethod
    def of(cls, app_services: AppServices, state: AppState) -> Session:
        """A session that begins where the last one ended."""
        known = {lesson.id: lesson for lesson in app_services.lessons}
        session = cls(app_services, known.get(state.lesson, app_services.lessons[0]), state)
        session.findings = {lesson.id: Findings.of(lesson) for lesson in app_services.lessons}
        return session

    @property
    def file(self) -> LessonFile:
        """The lesson's file that is shown."""
        return self.lesson.files[self.file_index]

    @property
    def path(self) -> Path:
        """Where that file is."""
        return self.app_services.path(self.file)

    @property
    def paths(self) -> list[Path]:
        """Where the lesson's files are."""
        return [self.app_services.path(file) for file in self.lesson.files]

    @property
    def run_options(self) -> RunOptions:
        """How the lesson's node is to be run."""
        return self.state.run_of(self.lesson.id)
