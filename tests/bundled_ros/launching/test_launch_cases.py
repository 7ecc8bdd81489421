"""Each case, run with our launch and, if it is installed, with the real one."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

from tests.bundled_ros.launching.case import Case
from tests.bundled_ros.launching.cases import arguments, conditions, events, frontends, nodes, scoping
from tests.bundled_ros.launching.launcher import Launcher

ALL = tuple(case for table in (arguments, scoping, conditions, nodes, events, frontends) for case in table.CASES)
REAL = all(importlib.util.find_spec(name) is not None for name in ("launch", "launch_ros"))


def test_cases_are_many_and_distinct_and_name_their_sources() -> None:
    assert len(ALL) >= 45
    assert len({case.id for case in ALL}) == len(ALL)
    assert all(case.source.startswith(("launch", "ros2launch", "docs.ros.org")) for case in ALL)


@pytest.mark.parametrize("case", ALL, ids=lambda case: case.id)
def test_our_launch(case: Case, launcher: Launcher) -> None:
    assert_case(case, launcher, python_path="")


@pytest.mark.skipif(not REAL, reason="no real launch is installed")
@pytest.mark.parametrize("case", ALL, ids=lambda case: case.id)
def test_real_launch(case: Case, tmp_path: Path) -> None:
    assert_case(case, Launcher(tmp_path), python_path=os.environ.get("PYTHONPATH", ""))


def assert_case(case: Case, launcher: Launcher, *, python_path: str) -> None:
    ran = launcher.run_case(case, python_path)
    shown = "\n".join(ran.lines)
    assert first_unmatched(case.log, ran.log) is None, (
        f"not in this order: {first_unmatched(case.log, ran.log)}\n{shown}"
    )
    output = [line for lines in ran.printed.values() for line in lines]
    for text in case.absent:
        assert not any(text in line for line in (*ran.log, *output)), shown
    if case.printed or "output" in case.id:
        assert ran.printed == dict(case.printed), shown
    assert ran.code == case.code, shown
    assert not ran.has_orphans, shown


def first_unmatched(expected: Sequence[str], lines: Sequence[str]) -> str | None:
    """Return the first pattern (`*` matches anything) without a matching line after those of the patterns before it."""
    rest = iter(lines)
    for pattern in expected:
        plain = pattern.replace("[", "[[]")
        if not any(fnmatchcase(line, plain) for line in rest):
            return pattern
    return None
