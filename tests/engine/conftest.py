"""Run the engine in this process, on real processes and real DDS, and restore ROS's variables afterwards."""

from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import AsyncIterator, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tests.engine.helpers import Scene
from tutor.engine.environment import NODE_MODULES, start_fork_server
from tutor.engine.machine import Machine
from tutor.engine.scheduling import StartLimiter
from tutor.process.spawner import Spawner
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
def machine(ros: RosEnvironment) -> Iterator[Machine]:
    """The machine with a server that nodes are forked from, as in a check."""
    with start_fork_server(ros, NODE_MODULES) as server:
        yield Machine(ros, spawner=Spawner(server))


@pytest.fixture
async def scene(machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Scene]:
    """Runs learners' scripts; after the test none of their processes may be left, and no domain reserved."""
    scene = Scene(replace(machine, starts=StartLimiter()), tmp_path, monkeypatch)
    yield scene
    leftovers = scene.leftovers()
    assert not leftovers
    assert not scene.reserved_domains
