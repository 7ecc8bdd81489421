"""Everything that ros-tutor can have to say in place of doing what was asked, as one tree under TutorError.

- UserError, what was asked for cannot be done as asked: UsageError, UnknownExercise, CommandRefused, CommandError,
  EditorError, WorkspaceError (SubmissionError)
- StorageError, the machine refuses to read or write; ServeError (NoAddress), the app cannot be served
- ContentError, TableError: the course is broken
- UnknownType, ProbeFailed, InterfacesNotBuiltError: this ROS lacks something
- Fault, a check cannot be carried out, by the tool or the machine: EngineError, NoFreeDomain, MachineTooBusy,
  NeedsInstalledRos, ProcessError (StartError, EndError)
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tutor.invocation import command


class TutorError(Exception):
    """The message is one line. `hint` says what to do about it; empty where the message itself does.

    `exit_code` is what a command ends with: 2 for wrong usage, 3 for a fault of the tool or the machine.
    """

    exit_code = 3

    def __init__(self, what: str, hint: str = "") -> None:
        super().__init__(what)
        self.hint = hint


# --- what was asked for cannot be done as asked ---


class UserError(TutorError):
    """Something that was asked for cannot be done as asked; the message says what can be."""

    exit_code = 2


class UsageError(UserError):
    """The command line asks for something that there is not."""


class UnknownExercise(UserError):
    """Nobody knows this exercise. The message names the known ones, and the one that was probably meant."""

    def __init__(self, text: str, known: Sequence[str]) -> None:
        from difflib import get_close_matches  # late: every `ros2` command imports this module

        self.text = text
        self.known = tuple(known)
        near = get_close_matches(text.strip().lower().replace("_", "."), self.known, n=1, cutoff=0.5)
        self.nearest = near[0] if near else None
        guess = f" Did you mean {self.nearest}?" if self.nearest else ""
        super().__init__(f"There is no exercise {text!r}.{guess} The exercises are: {', '.join(self.known)}.")


class CommandRefused(UserError):
    """A command of the plain dialog cannot be done now."""


class CommandError(UserError):
    """A command of `ros2` cannot be done; the message goes to stderr as it stands. `code` is the exit code."""

    def __init__(self, text: str, code: int = 1) -> None:
        super().__init__(text)
        self.code = code


class EditorError(UserError):
    """There is no editor to start."""


class WorkspaceError(UserError):
    """A workspace cannot be used as asked."""


class SubmissionError(WorkspaceError):
    """The files to check are not there, or cannot be read."""


# --- the machine, the course, and the ROS that is there ---


class ServeError(TutorError):
    """The app cannot be served."""


class NoAddress(ServeError):
    """The host that was asked for is none of this machine's addresses."""

    exit_code = 2


class StorageError(TutorError):
    """The machine refuses to read or write (permissions, a full disk). The message names the path."""

    @classmethod
    def of(cls, doing: str, error: OSError) -> StorageError:
        """Translate an OSError; `doing` completes "cannot ..."."""
        return cls(f"cannot {doing}: {error.strerror or error}")


class ContentError(TutorError):
    """A course file is broken: its author's mistake, never a learner's.

    `line` counts from 1; None means the whole file. `field` is the field's place in it, as in `criteria[2].hint`.
    """

    def __init__(self, file: Path, message: str, *, line: int | None = None, field: str = "") -> None:
        self.file = file
        self.line = line
        self.field = field
        self.message = message
        place = str(file) if line is None else f"{file}:{line}"
        super().__init__(f"{place}: {field}: {message}" if field else f"{place}: {message}")


class TableError(TutorError, ValueError):
    """A table of known exceptions that cannot be used: says which file and entry, and what is wrong there."""


class UnknownType(TutorError, LookupError):
    """A type name that this ROS does not have."""


class ProbeFailed(TutorError):
    """A probe of the doctor did not do what it should."""


class InterfacesNotBuiltError(TutorError, RuntimeError):
    """The bundled interfaces are missing from this installation."""


# --- a check cannot be carried out ---


class Fault(TutorError):
    """A fault of the tool or the machine, never of the learner. Without a hint, the doctor is pointed to."""

    def __init__(self, what: str, hint: str = "") -> None:
        super().__init__(what, hint or f"run `{command('doctor')}` to see what is wrong with this machine")


class EngineError(Fault):
    """A check could not be carried out."""


class NoFreeDomain(Fault):
    """Every domain id is taken."""

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
    """Some process could not be ended, although SIGKILL was sent to it."""


class MachineTooBusy(Fault):
    """The machine ran the learner's node too seldom to tell its own slowness from the node's."""

    def __init__(self, what: str) -> None:
        super().__init__(what, "close what keeps this machine busy, then check again")


class NeedsInstalledRos(Fault):
    """The learner uses something of a full ROS 2 that is not there without one: nothing can be said about it here."""

    def __init__(self, what: str) -> None:
        super().__init__(what, "install ROS 2 Jazzy, source its setup file, and check again")
