"""The errors of an author, judged by the real engine: each with file, line and one sentence."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tutor.content.exercise_template import new_exercise
from tutor.interpreter import module_command

SKELETON = "lessons/x1_1/skeleton/gate.py"
SOLUTION = "lessons/x1_1/solution/gate.py"
CHECK = "checks/x1_1.py"


@pytest.fixture
def course(tmp_path: Path) -> Path:
    root = tmp_path / "gates"
    new_exercise("x1.1", "Gate", root)
    return root


def author_check(course: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = module_command("tutor", "author", "check", *words, "--lessons", str(course))
    return subprocess.run(command, capture_output=True, text=True, timeout=110, check=False)


def edit(course: Path, file: str, old: str, new: str) -> None:
    text = (course / file).read_text()
    assert text.count(old) == 1
    (course / file).write_text(text.replace(old, new))


def line_of(course: Path, file: str, text: str) -> int:
    """The number of the one line that has this text."""
    (number,) = (number for number, line in enumerate((course / file).read_text().splitlines(), 1) if text in line)
    return number


def test_a_new_exercise_proves_itself(course: Path) -> None:
    answer = author_check(course)
    assert (answer.returncode, answer.stdout) == (0, "nothing is wrong: 1 exercise, 5 runs\n"), answer.stderr


def raise_in_criterion(course: Path) -> str:
    edit(course, CHECK, "    await node.rate(", "    1 / 0\n    await node.rate(")
    line = line_of(course, CHECK, "1 / 0")
    return rf"{CHECK}:{line}: your check: ZeroDivisionError: division by zero; it happened on rate of x1\.1 solution"


def misspell_method(course: Path) -> str:
    edit(course, CHECK, "await node.rate(", "await node.rat(")
    line = line_of(course, CHECK, "node.rat(")
    return rf"{CHECK}:{line}: your check: AttributeError: .* has no attribute 'rat'.*"


def fail_solution(course: Path) -> str:
    edit(course, SOLUTION, 'String(data="ready")', 'String(data="redy")')
    return r"lessons/x1_1/solution: status does not pass \(data: redy \| .*"


def pass_skeleton(course: Path) -> str:
    shutil.copy(course / SOLUTION, course / SKELETON)
    return r"lessons/x1_1/skeleton: status passes, but the lesson says that it is open \(data: ready\); .*"


def pass_wrong_submission(course: Path) -> str:
    name = "submissions/x1_1/wrong/other-topic.yaml"
    edit(course, name, '"/gate/state"', '"gate/status"')
    return rf"{name}:{line_of(course, name, 'fails:')}: should fail: status passed: .*"


def claim_another_mistake(course: Path) -> str:
    name = "submissions/x1_1/wrong/other-topic.yaml"
    edit(course, name, "mistake: wrong-topic", "mistake: no-publisher")
    return rf"{name}:\d+: status: mistake is wrong-topic, not no-publisher; .*"


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (raise_in_criterion, ("x1.1",)),
        (misspell_method, ("x1.1/right/",)),
        (fail_solution, ()),
        (pass_skeleton, ()),
        (pass_wrong_submission, ("x1.1/wrong/other-topic",)),
        (claim_another_mistake, ("x1.1/wrong/other-topic",)),
    ],
)
def test_an_authors_error_is_a_finding_with_its_place(
    course: Path, spoil: Callable[[Path], str], words: tuple[str, ...]
) -> None:
    expected = spoil(course)
    answer = author_check(course, *words)
    lines = [line.replace(f"{course}/", "") for line in answer.stdout.splitlines()]
    assert any(re.fullmatch(expected, line) for line in lines), (expected, answer.stdout, answer.stderr)
    assert answer.returncode == 1
    assert "fault of ros-tutor" not in answer.stdout


def test_a_learner_is_told_that_the_exercise_is_wrong_not_their_code(course: Path) -> None:
    raise_in_criterion(course)
    command = module_command("tutor", "check", "x1.1", "--solution", "--lessons", str(course))
    answer = subprocess.run(command, capture_output=True, text=True, timeout=110, check=False)
    assert answer.returncode == 3
    assert "this is a mistake in the exercise, not in your code: tell whoever wrote it" in " ".join(
        answer.stdout.split()
    )


def test_an_exercise_that_needs_a_type_that_is_not_there_says_so_in_one_line(course: Path) -> None:
    edit(course, CHECK, "std_msgs/msg/String", "turtlesim/msg/Pose")
    command = module_command("tutor", "check", "x1.1", "--solution", "--lessons", str(course))
    answer = subprocess.run(command, capture_output=True, text=True, timeout=110, check=False)
    assert answer.returncode == 3
    (line,) = answer.stderr.splitlines()
    assert "this exercise needs turtlesim/msg/Pose, which this ROS does not have" in line
    assert "apt install ros-jazzy-turtlesim" in line
