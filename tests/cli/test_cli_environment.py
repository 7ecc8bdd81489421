"""Neither the current folder nor the shell's environment variables change what our programs run."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tutor import interpreter

ROOT = Path(__file__).parents[2]
LIMIT_S = 300
"""The first start of a clone may have to set it up."""

HIJACK = "import os; os.write(1, b'taken'); os._exit(0)"
SHADOWED_MODULES = ("sitecustomize", "usercustomize", "random", "typing", "rich", "tutor", "checks", "rclpy")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A submission's folder with modules that would shadow ours and exit as if all was well."""
    for name in SHADOWED_MODULES:
        (tmp_path / f"{name}.py").write_text(HIJACK)
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
# Python reads these only if it is not told to ignore them, and each alone would then change what runs.
ENVIRONMENTS: dict[str, dict[str, str]] = {
    "the folder, by each of its names, and what Python reads at its start": {
        "PYTHONPATH": ".::FOLDER:/x",
        "PYTHONINSPECT": "1",
        "PYTHONSTARTUP": "FOLDER/random.py",
        "PYTHONWARNINGS": "error",
        "PYTHONUSERBASE": "FOLDER",
    },
    "another Python's home": {"PYTHONHOME": "FOLDER"},
    "settings of uv": {
        "UV_PYTHON": "3.9",
        "UV_ENV_FILE": "FOLDER/none",
        "UV_PROJECT_ENVIRONMENT": "FOLDER/venv",
        "UV_NO_PROJECT": "1",
    },
}


@pytest.mark.parametrize("variables", ENVIRONMENTS.values(), ids=ENVIRONMENTS)
def test_the_clones_program_is_not_hijacked(folder: Path, variables: dict[str, str]) -> None:
    result = run([*PROGRAMS["clone"], "check", "i9.9", "."], folder, variables)
    assert (result.returncode, result.stdout) == (2, ""), result
    assert "i9.9" in result.stderr


@pytest.mark.parametrize("program", ["installed", "engine"])
def test_our_other_programs_are_not_hijacked(program: str, folder: Path) -> None:
    words = ["check", "i9.9", "."] if program == "installed" else ["i9.9", "."]
    result = run([*PROGRAMS[program], *words], folder, {"PYTHONPATH": ".:FOLDER"})
    assert (result.returncode, result.stdout) == (2, ""), result
    assert "i9.9" in result.stderr


def test_a_check_is_judged_whatever_the_folder_holds(folder: Path) -> None:
    argv = [*PROGRAMS["clone"], "check", "i1.1", ".", "--criterion", "publishes"]
    result = run(argv, folder, {"PYTHONPATH": f".:{folder}"})
    assert result.returncode == 1, result
    assert "publishes" in result.stdout
    assert "failed" in result.stdout


def test_paths_of_a_sourced_ros_come_after_our_own(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sys, "path", ["/ours"])
    interpreter.add_python_path({"PYTHONPATH": f".::{tmp_path}:relative:/ours"})
    assert sys.path == ["/ours", str(tmp_path)]
