"""`ros-tutor author check --watch`: what is proved again after a save."""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tutor.cli.author_watch import changed
from tutor.content.exercise_template import new_exercise
from tutor.interpreter import module_command

LIMIT_S = 60.0


@pytest.mark.parametrize(
    ("saved", "proved"),
    [
        (["lessons/x1_1/lesson.md"], ["x1.1"]),
        (["lessons/x1_1/solution/gate.py", "checks/x1_2.py"], ["x1.1", "x1.2"]),
        (["checks/x1_2_garden_gate/judges.py"], ["x1.2"]),
        (["submissions/x1_1/wrong/other-topic.yaml"], ["x1.1/wrong/other-topic"]),
        (["submissions/x1_1/right/plain/gate.py", "submissions/x1_1/right/plain/expect.yaml"], ["x1.1/right/plain"]),
        (["submissions/x1_1/wrong/a.yaml", "checks/x1_1.py"], ["x1.1"]),
        (["checks/common.py", "checks/x1_1.py"], []),
        (["lessons/checklist.yaml"], []),
        (["course.yaml"], []),
    ],
)
def test_what_a_save_may_affect_is_proved_again(saved: list[str], proved: list[str]) -> None:
    root = Path("/course")
    assert changed(root, (root / name for name in saved)) == proved


@contextmanager
def watching(course: Path) -> Iterator[queue.Queue[str]]:
    """Run the command; yield the lines that it prints. At the end, Ctrl+C ends it."""
    command = module_command("tutor", "author", "check", "--watch", "--lessons", str(course))
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True
    ) as process:
        lines: queue.Queue[str] = queue.Queue()

        def read() -> None:
            for line in process.stdout or ():
                lines.put(line.strip())

        reader = threading.Thread(target=read)
        reader.start()
        try:
            yield lines
        finally:
            os.killpg(process.pid, signal.SIGINT)
            code = process.wait(LIMIT_S)
            reader.join(LIMIT_S)
    assert code == 130


def until(lines: queue.Queue[str], text: str) -> list[str]:
    """Return the lines up to the first that has this text."""
    seen = [lines.get(timeout=LIMIT_S)]
    while text not in seen[-1]:
        seen.append(lines.get(timeout=LIMIT_S))
    return seen


def test_a_save_is_proved_again_until_ctrl_c(tmp_path: Path) -> None:
    course = tmp_path / "gates"
    new_exercise("x1.1", "Gate", course)
    (course / "checks" / "x1_1.py").write_text("CHECK = (\n")  # then nothing is run
    with watching(course) as lines:
        first = until(lines, "waiting for the next save")
        assert any("checks/x1_1.py:1: your check: '(' was never closed" in line for line in first)
        (course / "checks" / "x1_1.py").write_text("\n\nCHECK = 1 +\n")
        second = until(lines, "waiting for the next save")
        assert any("checks/x1_1.py:3: your check: invalid syntax" in line for line in second)


def test_watch_needs_a_course_of_ones_own(run: Run) -> None:
    result = run("author", "check", "--watch")
    assert (result.code, result.out) == (2, "")
    assert "--watch needs one course of your own: name its folder with --lessons DIR" in result.err
