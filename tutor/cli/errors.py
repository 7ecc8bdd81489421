"""Exit codes, and the message for an error that ends a command."""

from __future__ import annotations

from tutor.errors import ContentError, TutorError

PASSED = 0
NOT_PASSED = 1
FAULT = 3
INTERRUPTED = 130


def exit_code(error: Exception) -> int:
    """Return the exit code for an error that ends a command."""
    return error.exit_code if isinstance(error, TutorError) else FAULT


def describe(error: Exception) -> str:
    """Return a one-line message about the error."""
    text = " ".join(str(error).split())
    if isinstance(error, TutorError):
        course = "the course is broken: " if isinstance(error, ContentError) else ""
        return f"{course}{text}; {' '.join(error.hint.split())}" if error.hint else f"{course}{text}"
    if isinstance(error, OSError):
        return text or type(error).__name__
    return f"something went wrong in ros-tutor itself: {type(error).__name__}: {text} (ROS_TUTOR_DEBUG=1 shows where)"
