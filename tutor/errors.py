"""All errors of ros-tutor, as one hierarchy under TutorError.

- UserError: the request cannot be carried out as given. UsageError, UnknownExercise, CommandRefused, CommandError,
  EditorError, WorkspaceError (SubmissionError)
- StorageError: the machine refuses to read or write; ServeError (NoAddress): the app cannot be served
- ContentError, TableError: the course is broken
- UnknownType, ProbeFailed, InterfacesNotBuiltError: this ROS lacks something
- Fault: the tool or the machine cannot carry out a check. EngineError (CheckError, MissingType: its own code),
  NoFreeDomain, MachineTooBusy, NeedsInstalledRos, ProcessError (StartError, EndError)
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tutor.invocation import command


class TutorError(Exception):
    """Base class. The message is one line. `hint` says what to do about it, and is empty if the message does.

    `exit_code` is the exit code of a command: 2 for wrong usage, 3 for a fault of the tool or the machine.
    """

    exit_code = 3

    def __init__(self, what: str, hint: str = "") -> None:
        super().__init__(what)
        self.hint = hint


# --- the request cannot be carried out as given ---


class UserError(TutorError):
    """The request cannot be carried out as given; the message says what is possible."""

    exit_code = 2


class UsageError(UserError):
    """The command line is wrong."""


class UnknownExercise(UserError):
    """There is no such exercise. The message lists all exercises, and the one that was probably meant."""

    def __init__(self, text: str, known: Sequence[str]) -> None:
        from difflib import get_close_matches  # imported late: every `ros2` command imports this module

        self.text = text
        self.known = tuple(known)
        matches = get_close_matches(text.strip().lower().replace("_", "."), self.known, n=1, cutoff=0.5)
        self.nearest = matches[0] if matches else None
        guess = f" Did you mean {self.nearest}?" if self.nearest else ""
        super().__init__(f"There is no exercise {text!r}.{guess} The exercises are: {', '.join(self.known)}.")


class CommandRefused(UserError):
    """A command of the plain dialog is not possible at the moment."""


class CommandError(UserError):
    """A `ros2` command failed; the message goes to stderr verbatim. `code` is the exit code."""

    def __init__(self, text: str, code: int = 1) -> None:
        super().__init__(text)
        self.code = code


class EditorError(UserError):
    """There is no editor to start."""


class WorkspaceError(UserError):
    """A workspace cannot be used as requested."""


class SubmissionError(WorkspaceError):
    """The files to check are missing or unreadable."""


# --- the machine, the course, and the ROS in use ---


class ServeError(TutorError):
    """The app cannot be served."""


class NoAddress(ServeError):
    """The requested host is not an address of this machine."""

    exit_code = 2


class StorageError(TutorError):
    """The machine refuses to read or write (permissions, a full disk). The message names the path."""

    @classmethod
    def of(cls, doing: str, error: OSError) -> StorageError:
        """Translate an OSError; `doing` completes "cannot ..."."""
        return cls(f"cannot {doing}: {error.strerror or error}")


class ContentError(TutorError):
    """A course file is broken, which is its author's mistake, never a learner's.

    `line` counts from 1; None means the whole file. `field` is the path of the field, such as `criteria[2].hint`.
    """

    def __init__(self, file: Path, message: str, *, line: int | None = None, field: str = "") -> None:
        self.file = file
        self.line = line
        self.field = field
        self.message = message
        place = str(file) if line is None else f"{file}:{line}"
        super().__init__(f"{place}: {field}: {message}" if field else f"{place}: {message}")


class TableError(TutorError, ValueError):
    """A table of known exceptions is invalid. The message names the file and entry, and what is wrong there."""


class UnknownType(TutorError, LookupError):
    """A type name that is unknown to this ROS."""


class ProbeFailed(TutorError):
    """A probe of the doctor failed."""


class InterfacesNotBuiltError(TutorError, RuntimeError):
    """The bundled interfaces are missing from this installation."""


# --- a check cannot be carried out ---


class Fault(TutorError):
    """A fault of the tool or the machine, never of the learner. The default hint points to the doctor."""

    def __init__(self, what: str, hint: str = "") -> None:
        super().__init__(what, hint or f"run `{command('doctor')}` to see what is wrong with this machine")


class EngineError(Fault):
    """A check could not be carried out."""


class CheckError(EngineError):
    """The code of a check is wrong, which is its author's mistake, never a learner's.

    `problem` is one sentence. `line` counts from 1; None means the whole file.
    """

    BEGINNING = "the check of this exercise is wrong, "

    def __init__(self, file: Path, problem: str, line: int | None = None) -> None:
        self.file = file
        self.line = line
        self.problem = problem
        super().__init__(
            f"{self.BEGINNING}{self.place}: {problem}",
            "this is a mistake in the exercise, not in your code: tell whoever wrote it",
        )

    @property
    def place(self) -> str:
        """The file and the line."""
        return str(self.file) if self.line is None else f"{self.file}:{self.line}"


class MissingType(CheckError):
    """A check needs a type that this ROS does not have. `advice` says what may help."""

    def __init__(self, file: Path, type: str, line: int, advice: str) -> None:
        super().__init__(file, f"this ROS has no type {type}; {advice}", line)
        self.args = (f"this exercise needs {type}, which this ROS does not have ({self.place})",)
        self.hint = advice


class NoFreeDomain(Fault):
    """All domain ids are in use."""

    def __init__(self) -> None:
        super().__init__(
            "No ROS domain id is free for a check on this machine.",
            "Wait until other checks on this machine have ended (ps -ef shows them), and try again.",
        )


class ProcessError(Fault):
    """A process could not be handled."""


class StartError(ProcessError):
    """The process could not be started."""


class EndError(ProcessError):
    """Some process could not be ended, not even by SIGKILL."""


class MachineTooBusy(Fault):
    """The machine gave the learner's node so little CPU time that its slowness cannot be told from the node's."""

    def __init__(self, what: str) -> None:
        super().__init__(what, "close what keeps this machine busy, then check again")


class NeedsInstalledRos(Fault):
    """The learner uses a part of ROS 2 that only a full installation has, so the node cannot be judged here."""

    def __init__(self, what: str) -> None:
        super().__init__(what, "install ROS 2 Jazzy, source its setup file, and check again")
