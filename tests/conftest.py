"""A test runs as a program does that somebody has started in a terminal."""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

# On a loaded machine, how long one example takes says nothing of the code.
settings.register_profile("any machine", deadline=None)
settings.load_profile("any machine")


def pytest_configure() -> None:
    # The processes among which pytest-xdist divides the tests ignore Ctrl+C, as does what a script starts with `&`;
    # what they start themselves would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)


# A quarter of the tests' time went into looking through the objects of Textual's widgets for garbage.
gc.set_threshold(50_000, 20, 50)

PREPARES_FOR_RCLPY = Path(__file__).with_name("engine")


def pytest_collection_finish() -> None:
    """No test module imports rclpy, not even by way of ours: the tests of the engine would find it unprepared."""
    assert "rclpy" not in sys.modules, "a test module imports rclpy: import it in another process"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """No test but those of the engine imports rclpy here: unprepared, Fast DDS ends the worker in a later test."""
    before = "rclpy" in sys.modules
    yield
    if "rclpy" in sys.modules and not before:
        assert PREPARES_FOR_RCLPY in item.path.parents, "rclpy is imported: run the test's code in another process"


@pytest.fixture(autouse=True)
def _environment_is_left_as_it_was() -> Iterator[None]:
    """What a test leaves in the environment, every process inherits that a later test starts."""

    def variables() -> dict[str, str]:
        passing = ("PYTEST_CURRENT_TEST", "ROS_TUTOR_STARTED_AS")  # the latter names the process: it says so once
        return {name: value for name, value in os.environ.items() if name not in passing}

    before = variables()
    yield
    after = variables()
    changed = {name: after.get(name) for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
    assert not changed
