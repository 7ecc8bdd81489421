"""Make tests run as if somebody had started them in a terminal, and keep them from affecting each other."""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# No limits on time: on a loaded machine they say nothing about the code.
settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--quick", action="store_true", help="only the tests that start no process")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """With `--quick`, leave out the folders whose tests start processes; in the others, such a test is marked."""
    if not config.getoption("quick") or TESTS not in collection_path.parents:
        return None
    return collection_path.relative_to(TESTS).parts[0] not in QUICK or None


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("quick"):
        sys.addaudithook(_refuse_processes)
    # pytest-xdist workers ignore SIGINT, as do jobs that a shell script starts with `&`; the processes that the tests
    # start would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)


# A quarter of the test time went into garbage collection over Textual's widgets.
gc.set_threshold(50_000, 20, 50)

TESTS = Path(__file__).parent
ENGINE_TESTS = TESTS / "engine"
QUICK = {"checks", "exercise", "judge", "mistakes", "recordings", "report", "ros_model", "source"}
LONGEST_FIRST = [
    "tui/test_lessons_live.py",
    "tui/test_whole_lessons.py",
    "tui/test_check.py",
    "tui/test_live.py",
    "tui/test_killed.py",
    "tui/test_run.py",
    "tui/test_terminal.py",
    "tui/test_terminal_ros.py",
    "tui/test_edit.py",
    "tui/test_navigation.py",
    "tui/test_checklist.py",
    "tui/test_typeahead.py",
    "tui/test_foreign_text.py",
    "cli/test_cli_author.py",
    "engine/test_ros_run.py",
    "engine/test_isolate_option.py",
]
"""The files that take longest: pytest-xdist would begin with those of many tests, and wait for these at the end."""


def _refuse_processes(event: str, arguments: object) -> None:
    if event in ("subprocess.Popen", "os.fork", "os.posix_spawn") and "PYTEST_CURRENT_TEST" in os.environ:
        raise AssertionError("this test starts a process: mark it with pytest.mark.process")


def pytest_collection_finish() -> None:
    """No test module imports rclpy, not even indirectly: the engine's tests must prepare the environment first."""
    assert "rclpy" not in sys.modules, "a test module imports rclpy: import it in another process"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Begin with the files that take longest, so that no process is left alone with one at the end."""
    if config.getoption("quick"):
        items[:] = [item for item in items if item.get_closest_marker("process") is None]
    places = {TESTS / name: place for place, name in enumerate(LONGEST_FIRST)}
    items.sort(key=lambda item: places.get(item.path, len(places)))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Only the engine's tests import rclpy in this process: unprepared, Fast DDS kills the worker in a later test."""
    before = "rclpy" in sys.modules
    yield
    if "rclpy" in sys.modules and not before:
        assert ENGINE_TESTS in item.path.parents, "rclpy is imported: run the test's code in another process"


@pytest.fixture(autouse=True)
def _environment_unchanged() -> Iterator[None]:
    """Fail a test that leaves a change in `os.environ`: processes that later tests start would inherit it."""

    def variables() -> dict[str, str]:
        ignored = ("PYTEST_CURRENT_TEST", "ROS_TUTOR_STARTED_AS")  # the latter is set once per process
        return {name: value for name, value in os.environ.items() if name not in ignored}

    before = variables()
    yield
    after = variables()
    changed = {name: after.get(name) for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
    assert not changed
