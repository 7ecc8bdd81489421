"""What can go wrong with a workspace: the learner asked for something that cannot be, or the machine refuses."""

from __future__ import annotations


class WorkspaceError(Exception):
    """Something that was asked for cannot be done as asked. The message is one line that says what to do instead."""


class SubmissionError(WorkspaceError):
    """The files to check are not there, or cannot be read."""


class StorageError(Exception):
    """The machine refuses to read or write (permissions, a full disk). The message is one line that names the path."""

    @classmethod
    def of(cls, doing: str, error: OSError) -> StorageError:
        """Translate an OSError; `doing` completes "cannot ..."."""
        return cls(f"cannot {doing}: {error.strerror or error}")
