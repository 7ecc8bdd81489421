"""A program that is checked, or run from the app, has the environment of a terminal in which all is sourced."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from tutor.bundled_ros.ros2 import sourced, sources
from tutor.content import load_course
from tutor.engine import environment
from tutor.ros.environment import RosEnvironment, detect
from tutor.session.session import Session
from tutor.workspace import RunOptions, Workspace

USER_PATH = "/usr/local/bin:/usr/bin:/bin"
SYSTEM = RosEnvironment("system", "jazzy", Path("/usr/bin/python3.12"), "rmw_fastrtps_cpp")


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    root = tmp_path / "ws"
    (root / ".ros-tutor").mkdir(parents=True)
    for name in ("my_package", "other"):
        package = root / "src" / name
        (package / name).mkdir(parents=True)
        (package / name / "__init__.py").touch()
        (package / "package.xml").write_text(f"<package><name>{name}</name></package>")
        # Whatever is checked, setup.py is not run to find out from where a package is imported.
        (package / "setup.py").write_text("raise SystemExit('run')\nsetup(entry_points=made)")
    return root


def test_a_checked_program_finds_ros2_and_the_packages_of_its_workspace(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", USER_PATH)
    ros, tools = detect(), tmp_path / "tools"
    sourced.write_programs(tools, ros, os.environ)
    env = environment.node_env(ros, 7, workspace, None)
    environment.source_workspace(env, ros, workspace / "src/my_package/my_package/calculator_client.py", tools)
    assert shutil.which("ros2", path=env["PATH"]) == str(tools / "bin" / "ros2")
    script = "ros2 pkg prefix other && python3 -c 'import other, example_interfaces.srv'"
    done = subprocess.run(["sh", "-c", script], env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_workspace_of_a_file_is_the_one_around_it(workspace: Path) -> None:
    assert sources.workspace_around(workspace / "src/my_package/launch/my_launch.py") == workspace
    (workspace / ".ros-tutor").rmdir()
    assert sources.workspace_around(workspace / "src/my_package/launch/my_launch.py") == workspace
    assert sources.workspace_around(workspace / "loose.py") is None


def test_with_an_installed_ros_what_is_built_is_found_as_its_setup_file_would(workspace: Path) -> None:
    site = Path("lib/python3.12/site-packages")
    built = workspace / "install" / "my_package"
    (built / "share/ament_index/resource_index/packages").mkdir(parents=True)
    (built / site).mkdir(parents=True)
    (workspace / "install" / "COLCON_IGNORE").touch()
    env = {"PATH": "/opt/ros/jazzy/bin", "AMENT_PREFIX_PATH": "/opt/ros/jazzy", "PYTHONPATH": "/opt/ros/py"}
    environment.source_workspace(env, SYSTEM, workspace / "src/my_package/my_package/a.py", workspace / "no-tools")
    roots = [str(workspace / "src" / name) for name in ("my_package", "other")]
    assert env == {
        "PATH": "/opt/ros/jazzy/bin",
        "AMENT_PREFIX_PATH": f"{built}:/opt/ros/jazzy",
        "PYTHONPATH": ":".join([*roots, str(built / site), "/opt/ros/py"]),
        "ROS_TUTOR_WORKSPACE": str(workspace),
    }


def test_another_ros2_on_the_path_takes_precedence(tmp_path: Path) -> None:
    theirs = tmp_path / "theirs" / "ros2"
    theirs.parent.mkdir()
    theirs.write_text("#!/bin/sh")
    theirs.chmod(0o755)
    env = {"PATH": f"{theirs.parent}:{USER_PATH}"}
    sourced.write_programs(tmp_path / "tools", detect(), env)
    sourced.add_programs(env, tmp_path / "tools")
    assert shutil.which("ros2", path=env["PATH"]) == str(theirs)


def test_a_node_run_from_the_app_finds_the_same(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", USER_PATH)
    session = Session(load_course(), Workspace(workspace))
    env = session.node_command(session.lessons[0].files[0], RunOptions()).env
    assert env["PATH"] == session.shell()[0].env["PATH"]
    assert shutil.which("ros2", path=env["PATH"])
    assert env["ROS_TUTOR_WORKSPACE"] == str(workspace)
