"""A test runs as a program does that somebody has started in a terminal."""

from __future__ import annotations

import signal

from hypothesis import settings

# On a loaded machine, how long one example takes says nothing of the code.
settings.register_profile("any machine", deadline=None)
settings.load_profile("any machine")


def pytest_configure() -> None:
    # The processes among which pytest-xdist divides the tests ignore Ctrl+C, as does what a script starts with `&`;
    # what they start themselves would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
