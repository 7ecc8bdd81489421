"""Messages that widgets and workers post to the screens, whose handlers then touch other widgets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from textual.message import Message

from tutor.judge.result import ExerciseResult
from tutor.session.node import NodeState
from tutor.workspace import LastCheck, Progress


@dataclass
class NodeChanged(Message):
    """One of the running nodes has printed something, or its state has changed.

    `restarted`: it has just been started again, not by the learner, but because its file was changed outside.
    """

    path: Path
    state: NodeState
    restarted: bool = False


@dataclass
class NodeChosen(Message):
    """The learner has chosen to see this node's log."""

    path: Path


@dataclass
class Started(Message):
    """An exercise was started; `written` are the names of the files that were put into the workspace."""

    exercise: str
    written: tuple[str, ...]


@dataclass
class FileTouched(Message):
    """A file of the lesson has appeared, changed or disappeared on disk, by whatever program, be it this app."""

    path: Path


@dataclass
class FileRead(Message):
    """The app has read a file, and knows its content on disk."""

    path: Path


@dataclass
class FileSaved(Message):
    """A file was saved on purpose: by the learner in this app, or (`outside`) in another program."""

    path: Path
    outside: bool = False


@dataclass
class EditorLeft(Message):
    """The learner has left the editor."""


@dataclass
class EditWanted(Message):
    """Request to edit the file shown, and to type this text there."""

    text: str


@dataclass
class GoToLine(Message):
    """Request to show a line (from 1) of a file in the editor."""

    path: Path
    line: int


@dataclass
class RunCommand(Message):
    """Request to run a command from the lesson's text in the terminal."""

    command: str


@dataclass
class ProgressRead(Message):
    """The learner's progress was read or has changed. `versions`: those of the exercises' files, read with it."""

    progress: Progress
    versions: Mapping[str, str]


@dataclass
class AttemptRecorded(Message):
    """A check was recorded; the progress with it has been posted before."""

    result: ExerciseResult


@dataclass
class LastChecksRead(Message):
    """The last checks of all exercises, from before the app was started, were read; by exercise id."""

    last: Mapping[str, LastCheck]


@dataclass
class ErrorOccurred(Message):
    """An action has failed; `text` says why, in one line."""

    text: str
