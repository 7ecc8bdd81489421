"""Reads the app's requests, and ends this process after the app has closed its stdin."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import BinaryIO

CLEAN_UP_S = 1.0
"""Time limit for leaving the domain after stdin is closed."""


def read_lines(source: BinaryIO, on_line: Callable[[str], None], on_end: Callable[[], None]) -> threading.Thread:
    """Read lines in a thread. At end of file, call `on_end` and exit this process at most `CLEAN_UP_S` later."""

    def read() -> None:
        for line in source:
            if text := line.decode("utf-8", "replace").strip():
                on_line(text)
        timer = threading.Timer(CLEAN_UP_S, os._exit, (0,))
        timer.daemon = True
        timer.start()
        on_end()

    thread = threading.Thread(target=read, name="requests", daemon=True)
    thread.start()
    return thread
