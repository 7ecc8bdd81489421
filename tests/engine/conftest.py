"""Run the engine in this process, on real processes and real DDS, and restore ROS's variables afterwards."""

from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import pytest

from tests.engine.helpers import Scene
from tutor.engine.forking import start_fork_server
from tutor.engine.preparation import NODE_MODULES
from tutor.process.fork_link import ForkServerLink
from tutor.ros import process_setup
from tutor.ros.environment import RosEnvironment, detect


@pytest.fixture(scope="module")  # "package" would mean the session: this folder is no package
def ros() -> Iterator[RosEnvironment]:
    """The ROS installation, chosen and isolated as for a check; `import rclpy` works from here on."""
    path = list(sys.path)
    environment = detect()
    with process_setup.environment_restored():
        process_setup.prepare_for_rclpy(environment, isolated=True)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # from ROS's own imports
            importlib.import_module("rosidl_generator_py")
            importlib.import_module("tutor.engine.runner")
        yield environment
    sys.path[:] = path


@pytest.fixture(scope="module")
def fork_server(ros: RosEnvironment) -> Iterator[ForkServerLink | None]:
    """The server that nodes are forked from, as in a check."""
    with start_fork_server(ros, NODE_MODULES) as server:
        yield server


@pytest.fixture
async def scene(
    ros: RosEnvironment, fork_server: ForkServerLink | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[Scene]:
    """Runs learners' scripts; after the test none of their processes may be left, and no domain reserved."""
    scene = Scene(ros, fork_server, tmp_path, monkeypatch)
    yield scene
    leftovers = scene.leftovers()
    assert not leftovers
    assert not scene.reserved_domains
