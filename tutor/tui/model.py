"""The app's state: the current lesson and file, the progress and findings, and the preferences to remember."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.session import Session
from tutor.session.findings import Findings
from tutor.workspace import AppState, Progress, RunOptions


@dataclass
class AppModel:
    """Shared by the screen and its controllers; only they change it, and only in the app's own thread."""

    session: Session
    lesson: Lesson
    state: AppState = field(default_factory=AppState)
    file_index: int = 0
    progress: Progress = field(default_factory=Progress)
    versions: Mapping[str, str] = field(default_factory=dict)
    """The version of each exercise's files when the progress was read, by exercise id."""
    findings: dict[str, Findings] = field(default_factory=dict)

    @classmethod
    def of(cls, session: Session, state: AppState) -> AppModel:
        """Create the initial model, with the lesson to open."""
        model = cls(session, session.lesson_to_open(state), state)
        model.findings = {lesson.id: Findings.of(lesson) for lesson in session.lessons}
        return model

    @property
    def file(self) -> LessonFile:
        """The file of the lesson that is shown."""
        return self.lesson.files[self.file_index]

    @property
    def path(self) -> Path:
        """That file's path in the workspace."""
        return self.session.path(self.file)

    @property
    def program(self) -> LessonFile:
        """The file that is run: the one shown or, if that is no program (a message type, parameters), the first one."""
        return self.file if self.file.name.endswith(".py") else self.lesson.files[0]

    @property
    def program_path(self) -> Path:
        """That file's path in the workspace."""
        return self.session.path(self.program)

    @property
    def paths(self) -> list[Path]:
        """The paths of all of the lesson's files."""
        return [self.session.path(file) for file in self.lesson.files]

    @property
    def run_options(self) -> RunOptions:
        """The run options (parameters and remaps) of the lesson."""
        return self.state.run_of(self.lesson.id)
