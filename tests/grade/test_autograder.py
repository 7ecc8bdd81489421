"""What `ros-tutor autograder` makes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.grade.autograders import CLASSROOM, OWN_COURSE, POINTS, SOLUTION, errors_in, make, make_archive, unzip


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_archive(tmp_path_factory.mktemp("made") / "autograder.zip")


def test_the_zip_has_what_gradescope_asks_for_at_its_top_and_executable(archive: Path) -> None:
    with zipfile.ZipFile(archive) as content:
        modes = {entry.filename: entry.external_attr >> 16 for entry in content.infolist()}
        settings = json.loads(content.read("settings.json"))
    assert {name for name, mode in modes.items() if mode & 0o111} == {"setup.sh", "run_autograder"}
    assert settings == {"exercises": ["i1.1"], "steps": True, "time_limit_s": 540.0}


def test_the_same_choices_make_the_same_file(archive: Path, tmp_path: Path) -> None:
    assert make("gradescope", tmp_path / "again.zip", "--exercise", "i1.1").returncode == 0
    assert (tmp_path / "again.zip").read_bytes() == archive.read_bytes()


def test_points_and_a_course_of_ones_own_travel_with_it(tmp_path: Path) -> None:
    (tmp_path / "points.toml").write_text(POINTS)
    words = ("--exercise", "h1.1", "--steps", "none", "--points", tmp_path / "points.toml", "--lessons", OWN_COURSE)
    made = make("gradescope", tmp_path / "autograder.zip", *words)
    assert made.returncode == 0, made.stderr
    with zipfile.ZipFile(tmp_path / "autograder.zip") as content:
        names = content.namelist()
        assert content.read("points.toml").decode() == POINTS
        assert json.loads(content.read("settings.json"))["steps"] is False
    assert {"course/lessons/h1_1/lesson.md", "course/checks/h1_1/__init__.py"} <= set(names)
    assert not [name for name in names if "__pycache__" in name]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--exercise", "i9.9"), "There is no exercise 'i9.9'"),
        (("--exercise", "i1.1", "--time-limit", "1"), "that leaves no time to judge"),
        (("--exercise", "i1.1", "--points", "/nowhere/points.toml"), "cannot be read"),
        ((), "--exercise"),
    ],
)
def test_wrong_usage_is_told_when_it_is_made(words: Sequence[str], says: str, tmp_path: Path) -> None:
    made = make("gradescope", tmp_path / "autograder.zip", *words)
    assert (made.returncode, made.stdout) == (2, "")
    assert says in made.stderr
    assert not (tmp_path / "autograder.zip").exists()


def judge_directly(system: str, bundle: Path, submission: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-I", "-B", "-X", "utf8", "-m", "tutor.grade.autograder", system]
    command += ["--bundle", str(bundle), "--submission", str(submission)]
    env = {"PATH": os.environ["PATH"], "HOME": str(submission), **CLASSROOM}
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=300, check=False)


def test_what_there_was_no_time_for_is_a_fault_of_ours(archive: Path, tmp_path: Path) -> None:
    bundle = tmp_path / "bundle"
    unzip(archive, bundle)
    (bundle / "settings.json").write_text('{"exercises": ["i1.1"], "steps": true, "time_limit_s": 0.001}')
    judged = judge_directly("gradescope", bundle, SOLUTION)
    assert judged.returncode == 0, judged.stderr
    results = json.loads(json.loads(judged.stdout)["results.json"])
    assert errors_in(results)
    assert "no time" in results["tests"][1]["output"]
    judged = judge_directly("classroom50", bundle, SOLUTION)
    assert (judged.returncode, judged.stdout) == (3, "")
    assert "not judged: i1.1: there was no time" in judged.stderr
