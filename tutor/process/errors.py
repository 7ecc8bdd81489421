"""What can go wrong with a process that is not the learner's fault."""

from __future__ import annotations


class ProcessError(Exception):
    """A fault of ours or of the machine in handling a process; its text is a clear sentence."""


class StartError(ProcessError):
    """The process could not be started."""


class EndError(ProcessError):
    """Some process could not be ended, although SIGKILL was sent to it."""
