"""What we ask of the kernel for our own processes. Linux only; elsewhere nothing is asked."""

from __future__ import annotations

import ctypes
import os
import signal

_PR_SET_PDEATHSIG = 1
_PR_SET_DUMPABLE = 4
_PR_SET_CHILD_SUBREAPER = 36


def die_with_parent(number: signal.Signals = signal.SIGKILL) -> None:
    """Get this signal when the parent dies: its pipes may be held open by others."""
    parent = os.getppid()
    if _prctl(_PR_SET_PDEATHSIG, number) and os.getppid() != parent:
        os._exit(0)


def guard() -> None:
    """Keep other programs of the user out of this process, until an exec: no debugger, no opening of its descriptors.

    What is in its /proc folder and not for everyone belongs to root then, its environment too.
    """
    _prctl(_PR_SET_DUMPABLE, 0)


def adopt_orphans(adopt: bool) -> None:
    """Become the parent of every descendant whose own parents have died, or leave them to those above again."""
    _prctl(_PR_SET_CHILD_SUBREAPER, adopt)


def _prctl(option: int, value: int) -> bool:
    try:
        return bool(ctypes.CDLL(None).prctl(option, value, 0, 0, 0) == 0)
    except (OSError, AttributeError):
        return False
