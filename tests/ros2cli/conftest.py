"""Benches for the tests."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.fork_server import ForkServer
from tests.ros2cli import bench as bench_module


@pytest.fixture(scope="session")
def ros2_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ForkServer]:
    """A server that forks commands and nodes."""
    with bench_module.ros2_server(tmp_path_factory.mktemp("server")) as provided:
        yield provided


@pytest.fixture
def bench(tmp_path: Path, ros2_server: ForkServer) -> Iterator[bench_module.Bench]:
    """A bench on a domain of its own."""
    with bench_module.bench(tmp_path, ros2_server) as provided:
        yield provided


@pytest.fixture(scope="module")
def module_bench(tmp_path_factory: pytest.TempPathFactory, ros2_server: ForkServer) -> Iterator[bench_module.Bench]:
    """A bench on a domain that the tests of a module share."""
    with bench_module.bench(tmp_path_factory.mktemp("bench"), ros2_server) as provided:
        yield provided
