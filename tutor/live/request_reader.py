"""Reads the app's requests, and ends this process when the app closes its input."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import BinaryIO

CLEAN_UP_S = 1.0
"""How long leaving the domain may take once the input is closed, in seconds."""


def read_lines(source: BinaryIO, on_line: Callable[[str], None], on_end: Callable[[], None]) -> threading.Thread:
    """Read lines in a thread. At their end, `on_end` is called, and `CLEAN_UP_S` later this process exits."""

    def read() -> None:
        for line in source:
            if text := line.decode("utf-8", "replace").strip():
                on_line(text)
        last = threading.Timer(CLEAN_UP_S, os._exit, (0,))
        last.daemon = True
        last.start()
        on_end()

    thread = threading.Thread(target=read, name="requests", daemon=True)
    thread.start()
    return thread
