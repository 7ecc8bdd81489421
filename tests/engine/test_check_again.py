"""What `tutor.engine.check` imports and leaves behind in the process that calls it."""

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
before = dict(os.environ)

async def check():
    report = await run_check([submission], course, only=frozenset({"services"}))
    print(report.verdict.value, report.environment.ros)

async def check_twice_at_once():
    await asyncio.gather(check(), check())

for checks in (check, check_twice_at_once):
    asyncio.run(checks())
    # Programs that the user starts from this process next must not inherit a check's environment.
    assert dict(os.environ) == before, set(os.environ.items()) ^ set(before.items())
"""


def test_checks_can_be_repeated_in_one_process() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", CHECKS_TWICE],
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert (ran.stderr, ran.returncode) == ("", 0)
    first, *later = ran.stdout.splitlines()
    assert first.startswith("passed ")
    assert later == [first, first]


NOTES_LATE_IMPORTS = """
import asyncio, sys
from tutor.content import load_course
from tutor.engine import run_check, unchanged
from tutor.workspace import solution

refuse, early = unchanged.refuse_changed_modules, set()
def refuse_and_note():
    refuse()
    early.update(sys.modules)
unchanged.refuse_changed_modules = refuse_and_note
course = load_course()
submissions = [solution(course.find(exercise)) for exercise in ("i1.1", "i1.3", "i2.1")]
print(asyncio.run(run_check(submissions, course, only=frozenset({"publishes", "services", "defaults"}))).verdict.value)
print(*{name.partition(".")[0] for name in set(sys.modules) - early} - {"tutor", "checks", *sys.stdlib_module_names})
"""


def test_no_ros_module_is_imported_while_a_learners_program_runs() -> None:
    """A late import is refused if the file changes meanwhile, even if only a hard link to it is added."""
    ran = subprocess.run(
        [sys.executable, "-c", NOTES_LATE_IMPORTS],
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert (ran.stderr, ran.stdout) == ("", "passed\n\n")
