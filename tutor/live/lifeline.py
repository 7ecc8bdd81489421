"""Ends this process with the one that started it, whatever happens to either."""

from __future__ import annotations

import ctypes
import os
import signal
import threading
from collections.abc import Callable
from typing import BinaryIO

CLEAN_UP_S = 1.0
"""How long leaving the domain may take once the input is closed, in seconds."""

_PR_SET_PDEATHSIG = 1


def die_with_parent(number: signal.Signals = signal.SIGKILL) -> None:
    """Get this signal when the parent dies: its pipes may be held open by others. Linux only; else the pipe must do."""
    parent = os.getppid()
    try:
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, number)
    except (OSError, AttributeError):
        return
    if os.getppid() != parent:
        os._exit(0)


def read_lines(source: BinaryIO, on_line: Callable[[str], None], on_end: Callable[[], None]) -> threading.Thread:
    """Read lines in a thread. At the end of the input `on_end` is called, and soon after this process is no more."""

    def read() -> None:
        for line in source:
            if text := line.decode("utf-8", "replace").strip():
                on_line(text)
        last = threading.Timer(CLEAN_UP_S, os._exit, (0,))
        last.daemon = True
        last.start()
        on_end()

    thread = threading.Thread(target=read, name="commands", daemon=True)
    thread.start()
    return thread
