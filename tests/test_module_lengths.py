"""No module is so long that a reader loses sight of what it holds."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
GENERATED = "tutor/bundled_ros/prefix"
MAX_LINES = 300

EXCEPTIONS: dict[str, str] = {}
"""The modules that may be longer, and why."""


def _modules() -> dict[str, int]:
    """Return the number of lines of each module, by its path."""
    modules = [path for package in ("tutor", "checks") for path in ROOT.joinpath(package).rglob("*.py")]
    own = [path for path in modules if not path.is_relative_to(ROOT / GENERATED)]
    return {str(path.relative_to(ROOT)): path.read_bytes().count(b"\n") for path in own}


@pytest.mark.parametrize("package", ["tutor", "checks"])
def test_no_module_is_above_300_lines(package: str) -> None:
    lines = {name: count for name, count in _modules().items() if name.startswith(f"{package}/")}
    assert lines
    assert {name: count for name, count in lines.items() if count > MAX_LINES and name not in EXCEPTIONS} == {}


def test_each_exception_is_still_one() -> None:
    modules = _modules()
    assert [name for name in EXCEPTIONS if modules.get(name, 0) <= MAX_LINES] == []
