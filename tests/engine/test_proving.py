"""Test submissions of a course are judged as ours are: what they leave behind, and that some keep the CPU busy."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.engine.helpers import lesson
from tutor.content import Checklist, Course
from tutor.content.proof import find_wrong_verdicts
from tutor.content.submissions import Case, Expected
from tutor.engine import leftovers, verification
from tutor.engine.machine import Machine
from tutor.engine.verification import Job, Kind, prove
from tutor.judge.check import Check
from tutor.judge.result import ExerciseResult
from tutor.judge.submission import Submission
from tutor.ros.environment import detect


@pytest.fixture(autouse=True)
def _machine(monkeypatch: pytest.MonkeyPatch) -> None:
    """No ROS is needed, since no check is run."""
    monkeypatch.setattr(verification, "prepare", lambda: nullcontext(Machine(detect())))


REPORT = SimpleNamespace(exercises=(ExerciseResult("t1", "Made", (), (), 0.0),))
COURSE = Course((), Checklist())


def job(name: str, **expected: Any) -> Job:
    """The job of a submission of which this is expected."""
    case = Case("t1", "wrong", Path(name), Expected("made", **expected))
    return Job(lesson(Check("t1", ())), Kind.SUBMISSION, Submission("t1", {}), case)


async def test_what_a_submission_leaves_behind_is_found(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    async def run_check(*_: object, **__: object) -> Any:
        return REPORT

    monkeypatch.setattr(verification, "run_check", run_check)
    monkeypatch.setattr(leftovers, "LIMIT_S", 0.3)
    text = f"left_by_{tmp_path.name}"
    (tmp_path / "expect.yaml").write_text(f"says: made\ngone: {text}\n")
    left = subprocess.Popen([sys.executable, "-c", "input()", text], stdin=subprocess.PIPE)
    try:
        one, other = await prove([job(str(tmp_path), gone=text), job("b", gone="no such text")], COURSE, lambda _: None)
    finally:
        left.communicate(b"\n")
    assert [text in command for command in one.left] == [True]
    assert other.left == ()
    assert one.job.case is not None
    (finding,) = find_wrong_verdicts(one.job.case, one.result, one.left)
    assert (finding.file, finding.line) == (tmp_path / "expect.yaml", 2)
    assert finding.text.startswith("left behind: ")
    assert text in finding.text


async def test_submissions_that_keep_the_cpu_busy_are_judged_one_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    running, most = 0, 0

    async def run_check(*_: object, **__: object) -> Any:
        nonlocal running, most
        running, most = running + 1, max(most, running + 1)
        for _turn in range(5):
            await asyncio.sleep(0)
        running -= 1
        return REPORT

    monkeypatch.setattr(verification, "run_check", run_check)
    await prove([job(name, keeps_busy=True) for name in "abc"], COURSE, lambda _: None)
    assert most == 1
    await prove([job(name) for name in "abc"], COURSE, lambda _: None)
    assert most == 3
