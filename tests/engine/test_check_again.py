"""What `tutor.engine.check` leaves behind, and brings along, in the process that calls it."""

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


def test_nothing_of_ros_is_imported_while_a_learners_program_runs() -> None:
    """It would be refused where its file changes meanwhile, be it that another environment is linked to it."""
    ran = subprocess.run(
        [sys.executable, "-c", NOTES_LATE_IMPORTS],
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert (ran.stderr, ran.stdout) == ("", "passed\n\n")
