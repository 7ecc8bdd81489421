"""Exit codes, and which error ends in which."""

from __future__ import annotations

PASSED = 0
NOT_PASSED = 1
USAGE = 2
FAULT = 3
INTERRUPTED = 130


class UsageError(Exception):
    """The command line asks for something that there is not. The message is one line that says what there is."""


def exit_code(error: Exception) -> int:
    """The exit code for an error that ends a command."""
    from tutor.content import UnknownExercise
    from tutor.workspace import WorkspaceError

    return USAGE if isinstance(error, (UsageError, UnknownExercise, WorkspaceError)) else FAULT


def describe(error: Exception) -> str:
    """What to say about it, in one line."""
    from tutor.content import ContentError, UnknownExercise
    from tutor.workspace import StorageError, WorkspaceError

    text = " ".join(str(error).split())
    if isinstance(error, (UsageError, UnknownExercise, WorkspaceError, StorageError)):
        return text
    if isinstance(error, ContentError):
        return f"the course is broken: {text}"
    if isinstance(error, OSError):
        return text or type(error).__name__
    hint = getattr(error, "hint", "")  # tutor.engine.EngineError has one; importing the engine here would cost a second
    if hint:
        return f"{text}; {' '.join(str(hint).split())}"
    return f"something went wrong in ros-tutor itself: {type(error).__name__}: {text} (ROS_TUTOR_DEBUG=1 shows where)"
