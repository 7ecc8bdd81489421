"""What workers tell the screens. Only the handlers of these messages touch widgets."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from textual.message import Message

from tutor.judge.events import Event
from tutor.session.check_process import CheckEnded
from tutor.session.node import NodeState
from tutor.workspace import Progress


@dataclass
class CheckEvent(Message):
    """The running check has something to tell."""

    event: Event


@dataclass
class CheckOver(Message):
    """The check's process is gone."""

    how: CheckEnded


@dataclass
class NodeChanged(Message):
    """A node of the learner's has said something, or its state has changed.

    `first`: it was started just now. `unasked`: not by a key of theirs, but because its file was changed outside.
    """

    path: Path
    state: NodeState
    first: bool = False
    unasked: bool = False


@dataclass
class NodeChosen(Message):
    """The log of this node is to be shown."""

    path: Path


@dataclass
class Started(Message):
    """An exercise was started; `written` are the files that were put into the workspace."""

    exercise: str
    written: tuple[str, ...]


@dataclass
class FileTouched(Message):
    """The file that is shown appeared, changed or went away on the disk, by whomever."""

    path: Path


@dataclass
class FileSaved(Message):
    """A file has new content on the disk, on purpose: saved by the learner, here or (`outside`) in another editor."""

    path: Path
    outside: bool = False


@dataclass
class EditorLeft(Message):
    """The learner is done typing for now."""


@dataclass
class GoToLine(Message):
    """A line of a file, from 1, is to be shown in the editor."""

    path: Path
    line: int


@dataclass
class RunCommand(Message):
    """A command of the lesson's text is to be run in the terminal."""

    command: str


@dataclass
class ProgressRead(Message):
    """The learner's progress was read or has changed."""

    progress: Progress


@dataclass
class ErrorOccurred(Message):
    """Something that was asked for could not be done; one line that says why."""

    text: str
