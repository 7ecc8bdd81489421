"""What surrounds a start, a learner's folder and the variables of a shell, has no part in what our programs run."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tutor import interpreter

ROOT = Path(__file__).parents[2]
LIMIT_S = 300
"""A first start of a clone may set it up."""

TAKEN = "import os; os.write(1, b'taken'); os._exit(0)"
SHADOWING = ("sitecustomize", "usercustomize", "random", "typing", "rich", "tutor", "checks", "rclpy")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A submission's folder, with modules that would take the place of ours and end the program, as if all was well."""
    for name in SHADOWING:
        (tmp_path / f"{name}.py").write_text(TAKEN)
    (tmp_path / "temperature_publisher.py").write_text("raise SystemExit(1)\n")
    return tmp_path


def run(argv: list[str], folder: Path, variables: dict[str, str]) -> subprocess.CompletedProcess[str]:
    env = {**os.environ, **{name: value.replace("FOLDER", str(folder)) for name, value in variables.items()}}
    return subprocess.run(argv, cwd=folder, env=env, capture_output=True, text=True, timeout=LIMIT_S)


PROGRAMS = {
    "clone": [str(ROOT / "ros-tutor")],
    "installed": [str(Path(sys.prefix) / "bin" / "ros-tutor")],
    "engine": list(interpreter.module_command("tutor.engine")),
}
SURROUNDINGS: dict[str, dict[str, str]] = {
    "the current folder": {"PYTHONPATH": "."},
    "an empty entry": {"PYTHONPATH": ":/x"},
    "the folder by its path": {"PYTHONPATH": "FOLDER"},
    "another Python's home": {"PYTHONHOME": "FOLDER"},
    "an interpreter that stays": {"PYTHONINSPECT": "1", "PYTHONSTARTUP": "FOLDER/random.py"},
    "warnings as errors": {"PYTHONWARNINGS": "error"},
    "a user's own packages": {"PYTHONUSERBASE": "FOLDER"},
    "settings of uv": {
        "UV_PYTHON": "3.9",
        "UV_ENV_FILE": "FOLDER/none",
        "UV_PROJECT_ENVIRONMENT": "FOLDER/venv",
        "UV_NO_PROJECT": "1",
    },
}


@pytest.mark.parametrize("variables", SURROUNDINGS.values(), ids=SURROUNDINGS)
def test_the_clones_program_is_not_taken_over(folder: Path, variables: dict[str, str]) -> None:
    ended = run([*PROGRAMS["clone"], "check", "i9.9", "."], folder, variables)
    assert (ended.returncode, ended.stdout) == (2, ""), ended
    assert "i9.9" in ended.stderr


@pytest.mark.parametrize("program", ["installed", "engine"])
@pytest.mark.parametrize("variables", [SURROUNDINGS["the current folder"], SURROUNDINGS["the folder by its path"]])
def test_no_other_program_of_ours_is(program: str, folder: Path, variables: dict[str, str]) -> None:
    words = ["check", "i9.9", "."] if program == "installed" else ["i9.9", "."]
    ended = run([*PROGRAMS[program], *words], folder, variables)
    assert (ended.returncode, ended.stdout) == (2, ""), ended
    assert "i9.9" in ended.stderr


def test_a_check_is_judged_whatever_the_folder_holds(folder: Path) -> None:
    argv = [*PROGRAMS["clone"], "check", "i1.1", ".", "--criterion", "publishes"]
    ended = run(argv, folder, {"PYTHONPATH": f".:{folder}"})
    assert ended.returncode == 1, ended
    assert "publishes" in ended.stdout
    assert "failed" in ended.stdout


def test_what_a_sourced_ros_names_is_found_behind_our_own(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sys, "path", ["/ours"])
    interpreter.add_python_path({"PYTHONPATH": f".::{tmp_path}:relative:/ours"})
    assert sys.path == ["/ours", str(tmp_path)]
