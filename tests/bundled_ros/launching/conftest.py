"""A launcher for each test."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.bundled_ros.launching.launcher import Launcher, launch_server
from tests.fork_server import ForkServer


@pytest.fixture(scope="session")
def server() -> Iterator[ForkServer]:
    """A server that forks launches."""
    with launch_server() as provided:
        yield provided


@pytest.fixture
def launcher(tmp_path: Path, server: ForkServer) -> Launcher:
    """A launcher whose launches are forked."""
    return Launcher(tmp_path, server)
