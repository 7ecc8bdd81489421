"""What `tutor.engine.check` imports and leaves behind in the process that calls it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

CHECKS_AGAIN = """
import asyncio, os, sys
from tutor.content import load_course
from tutor.engine import loading, run_check
from tutor.workspace import solution

refuse, early = loading.refuse_changed_modules, set()
def refuse_and_note():
    refuse()
    early.update(sys.modules)

async def check(**criteria):
    submissions = [solution(course.find(f"{name[0]}{name[1]}.{name[2]}")) for name in criteria]
    report = await run_check(submissions, course, only=frozenset(criteria.values()))
    print(report.verdict.value, report.environment.ros)

async def check_twice_at_once():
    await asyncio.gather(check(i13="services"), check(i13="services"))

course = load_course()
before = dict(os.environ)
loading.refuse_changed_modules = refuse_and_note
asyncio.run(check(i11="publishes", i13="services", i21="defaults"))
loading.refuse_changed_modules = refuse
late = {name.partition(".")[0] for name in set(sys.modules) - early} - {"tutor", "checks", *sys.stdlib_module_names}
print("late:", *late)
# Programs that the user starts from this process next must not inherit a check's environment.
assert dict(os.environ) == before, set(os.environ.items()) ^ set(before.items())
asyncio.run(check_twice_at_once())
assert dict(os.environ) == before, set(os.environ.items()) ^ set(before.items())
"""


def test_checks_can_be_repeated_in_one_process_and_import_no_ros_module_while_a_program_runs() -> None:
    """A late import is refused if the file changes meanwhile, even if only a hard link to it is added."""
    ran = subprocess.run(
        [sys.executable, "-c", CHECKS_AGAIN],
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert (ran.stderr, ran.returncode) == ("", 0)
    first, late, *again = ran.stdout.splitlines()
    assert first.startswith("passed ")
    assert late == "late:"
    assert again == [first, first]
