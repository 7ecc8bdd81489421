"""A test runs as a program does that somebody has started in a terminal."""

from __future__ import annotations

import signal


def pytest_configure() -> None:
    # The processes among which pytest-xdist divides the tests ignore Ctrl+C, as does what a script starts with `&`;
    # what they start themselves would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
