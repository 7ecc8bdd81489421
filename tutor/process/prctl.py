"""Kernel settings for our own processes through prctl(2). Does nothing outside Linux."""

from __future__ import annotations

import ctypes
import os
import signal

_PR_SET_PDEATHSIG = 1
_PR_SET_DUMPABLE = 4
_PR_SET_CHILD_SUBREAPER = 36


def die_with_parent(number: signal.Signals = signal.SIGKILL) -> None:
    """Get this signal when the parent dies. Waiting for end of file would not do: others may hold its pipes open."""
    parent = os.getppid()
    if _prctl(_PR_SET_PDEATHSIG, number) and os.getppid() != parent:
        os._exit(0)


def guard() -> None:
    """Protect this process from the user's other programs until an exec: no debugger, no access to its descriptors.

    The private files in its /proc folder, such as its environment, then belong to root.
    """
    _prctl(_PR_SET_DUMPABLE, 0)


def adopt_orphans(adopt: bool) -> None:
    """Become the subreaper, so that orphaned descendants become our children; or stop being it."""
    _prctl(_PR_SET_CHILD_SUBREAPER, adopt)


def _prctl(option: int, value: int) -> bool:
    try:
        return bool(ctypes.CDLL(None).prctl(option, value, 0, 0, 0) == 0)
    except (OSError, AttributeError):
        return False
