"""`tutor.engine.check` may be called as often as one likes, in one process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

CHECKS_TWICE = """
import asyncio, os
from tutor.content import load_course
from tutor.engine import run_check
from tutor.workspace import solution

course = load_course()
submission = solution(course.find("i1.3"))
for _ in range(2):
    report = asyncio.run(run_check([submission], course, only=frozenset({"services"})))
    print(report.verdict.value, report.environment.ros)
    os.environ.pop("FASTRTPS_DEFAULT_PROFILES_FILE", None)  # whoever puts the environment back must not undo isolation
"""


def test_a_second_check_in_the_same_process() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", CHECKS_TWICE],
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert (ran.stderr, ran.returncode) == ("", 0)
    first, second = ran.stdout.splitlines()
    assert first == second
    assert first.startswith("passed ")
