"""colcon builds a workspace as it is: a new one, and one in which everything is solved."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.workspace import Workspace, start

PACKAGE = "my_package"


def build(root: Path, log: Path) -> None:
    """Build with the colcon of this environment, as `colcon build` in the workspace does.

    Only the Python package: message types need ament_cmake, and are built in tests/interfaces/test_colcon.py.
    """
    environment = {**os.environ, "COLCON_HOME": str(log), "PYTHONDONTWRITEBYTECODE": ""}
    subprocess.run(
        [sys.executable, "-m", "colcon", "--log-base", log, "build", "--packages-select", PACKAGE],
        cwd=root,
        env=environment,
        check=True,
        timeout=100,
    )


def found_in_the_overlay(root: Path, module: str) -> str:
    """The file of a module as Python finds it once the built workspace is sourced."""
    code = f"import importlib.util; print(importlib.util.find_spec('{PACKAGE}.{module}').origin)"
    done = subprocess.run(
        ["bash", "-c", f'. install/setup.bash && exec {sys.executable} -P -c "{code}"'],
        cwd=root,
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout.strip()


@pytest.mark.parametrize("solved", [False, True], ids=["skeletons", "solutions"])
def test_colcon_builds_the_workspace(tmp_path: Path, *, solved: bool) -> None:
    workspace = Workspace(tmp_path / "ws")
    for lesson in load_course().lessons:
        files = start(lesson, workspace).files.written
        solutions = {workspace.path_of(file.name): file.solution for file in lesson.files}
        for file in files if solved else ():
            shutil.copyfile(solutions[file], file)

    build(workspace.root, tmp_path / "log")

    installed = workspace.root / "install" / PACKAGE
    programs = {path.name for path in (installed / "lib" / PACKAGE).iterdir()}
    modules = {path.stem for path in (workspace.root / "src" / PACKAGE / PACKAGE).glob("[!_]*.py")}
    assert programs == modules >= {"temperature_publisher", "calculator_client", "concurrent_service"}
    assert (installed / "share" / PACKAGE / "launch/my_launch.py").is_file()
    assert found_in_the_overlay(workspace.root, "temperature_publisher").startswith(str(installed))
