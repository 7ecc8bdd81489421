"""A bench for each test."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.ros2cli import bench as bench_module


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[bench_module.Bench]:
    """A bench on a domain of its own."""
    with bench_module.bench(tmp_path) as provided:
        yield provided
