"""Each case of the table, with ours and, where there is one, with the real launch."""

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


def test_the_table_is_large_and_says_where_each_case_is_from() -> None:
    assert len(ALL) >= 45
    assert len({case.id for case in ALL}) == len(ALL)
    assert all(case.source.startswith(("launch", "ros2launch", "docs.ros.org")) for case in ALL)


@pytest.mark.parametrize("case", ALL, ids=lambda case: case.id)
def test_ours(case: Case, tmp_path: Path) -> None:
    judge(case, Launcher(tmp_path), python_path="")


@pytest.mark.skipif(not REAL, reason="no real launch is installed")
@pytest.mark.parametrize("case", ALL, ids=lambda case: case.id)
def test_real(case: Case, tmp_path: Path) -> None:
    judge(case, Launcher(tmp_path), python_path=os.environ.get("PYTHONPATH", ""))


def judge(case: Case, launcher: Launcher, *, python_path: str) -> None:
    ran = launcher.run_case(case, python_path)
    shown = "\n".join(ran.lines)
    assert missing(case.log, ran.log) is None, f"not in this order: {missing(case.log, ran.log)}\n{shown}"
    said = [line for lines in ran.says.values() for line in lines]
    for text in case.absent:
        assert not any(text in line for line in (*ran.log, *said)), shown
    if case.says or "output" in case.id:
        assert ran.says == dict(case.says), shown
    assert ran.code == case.code, shown
    assert not ran.left, shown


def missing(expected: Sequence[str], lines: Sequence[str]) -> str | None:
    """The first of the patterns (`*` stands for anything) that no line matches behind those before it."""
    rest = iter(lines)
    for pattern in expected:
        plain = pattern.replace("[", "[[]")
        if not any(fnmatchcase(line, plain) for line in rest):
            return pattern
    return None
