"""A course from outside the package, given with --lessons: tests/courses/greeting, whose check is a package."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from tutor.interpreter import module_command

COURSE = Path(__file__).parents[1] / "courses" / "greeting"


def run_check(course: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = module_command("tutor", "check", "h1.1", "--lessons", str(course), *arguments)
    return subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)


def test_an_outside_check_is_loaded_with_its_own_modules_and_dataclasses() -> None:
    answer = run_check(COURSE, "--solution", "--format", "json")
    (exercise,) = json.loads(answer.stdout)["exercises"]
    assert (answer.returncode, exercise["verdict"]) == (0, "passed")


def test_an_outside_course_has_mistakes_of_its_own() -> None:
    command = module_command("tutor", "explain", "greets-nobody", "--lessons", str(COURSE))
    answer = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
    assert (answer.returncode, answer.stdout.partition("\n")[0]) == (0, "greets-nobody: A text is no greeting.")


@pytest.mark.parametrize("place", ["package", "module"])
def test_an_error_in_an_outside_check_names_the_authors_file(tmp_path: Path, place: str) -> None:
    course = shutil.copytree(COURSE, tmp_path / "course")
    package = course / "checks" / "h1_1" / "__init__.py"
    file = package if place == "package" else package.with_name("words.py")
    if file is not package:
        file.write_text("")
        package.write_text(package.read_text() + "\nfrom checks.h1_1 import words\n")
    file.write_text(file.read_text() + "\nimport no_such_module\n")
    answer = run_check(course, "--solution")
    assert answer.returncode == 3, answer
    assert str(file) in answer.stdout + answer.stderr
