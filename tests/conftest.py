"""A test runs as a program does that somebody has started in a terminal."""

from __future__ import annotations

import signal


def pytest_configure() -> None:
    # What a script starts with `&` ignores Ctrl+C, and what it starts itself would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
