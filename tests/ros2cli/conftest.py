"""The bench of each test."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.ros2cli import bench as benches


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[benches.Bench]:
    """A domain of its own."""
    with benches.bench(tmp_path) as made:
        yield made
