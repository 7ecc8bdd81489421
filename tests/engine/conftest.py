"""The engine in this process, on real processes and real DDS; ROS's variables are put back afterwards."""

from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import pytest

from tests.engine.made import Scene
from tutor.ros import process_setup
from tutor.ros.environment import RosEnvironment, detect


@pytest.fixture(scope="module")  # "package" would last as long as the session: this folder is no package
def ros() -> Iterator[RosEnvironment]:
    """ROS, chosen and isolated as for a check; `import rclpy` works from here on."""
    path = list(sys.path)
    chosen = detect()
    with process_setup.environment_restored():
        process_setup.prepare_for_rclpy(chosen, isolated=True)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what ROS itself imports
            importlib.import_module("rosidl_generator_py")
            importlib.import_module("tutor.engine.runner")
        yield chosen
    sys.path[:] = path


@pytest.fixture
async def scene(ros: RosEnvironment, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Scene]:
    """A place for learners' scripts; after the test no process of theirs is left, nor a domain of ours reserved."""
    scene = Scene(ros, tmp_path, monkeypatch)
    yield scene
    left = scene.left()
    assert not left
    assert not scene.held
