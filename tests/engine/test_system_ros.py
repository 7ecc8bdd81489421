"""With an installed ROS 2 Jazzy sourced, that one is used, and nothing of ours is on its paths.

It is laid out as /opt/ros/jazzy is, from the files of the wheels, with a `ros2` and a `launch` of its own.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from tutor.ros import bundled_interfaces
from tutor.ros.environment import detect
from tutor.ros.prefixes import SITE_PACKAGES

TUTOR = [sys.executable, "-P", "-c", "import sys; from tutor.cli import main; sys.exit(main())"]
BASE_PYTHON = Path(getattr(sys, "_base_executable", sys.executable)).resolve()
NOT_ROS = ("ros_tutor", "rosetta")
OF_THE_DISTRIBUTION = ("numpy", "numpy.libs", "yaml", "_yaml")
"""What a Debian package of ROS takes from those of Python."""

RUN_ANYWHERE = """\
import os, sys
import example_interfaces.srv, launch, rclpy, std_msgs.msg
modules = (example_interfaces.srv, launch, rclpy, std_msgs.msg)
print(*(module.__file__ for module in modules), *sys.path, os.environ["PATH"], os.environ["LD_LIBRARY_PATH"], sep=":")
"""


def copy(source: Path, target: Path) -> None:
    """Copy a file or folder, by links where the disk allows it."""
    target.parent.mkdir(parents=True, exist_ok=True)
    if subprocess.run(["cp", "-alT", source, target], capture_output=True, check=False).returncode:
        subprocess.run(["cp", "-aT", source, target], check=True)


def merge(source: Path, target: Path) -> None:
    """Copy the files of a folder into one that may exist."""
    target.mkdir(parents=True, exist_ok=True)
    subprocess.run(["cp", "-aT", source, target], check=True)


@pytest.fixture(scope="module")
def jazzy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The prefix of an installed ROS 2 Jazzy."""
    prefix = tmp_path_factory.mktemp("opt") / "jazzy"
    ours, interfaces = Path(sys.prefix), bundled_interfaces.prefix()
    for root in (ours, interfaces):
        merge(root / "share", prefix / "share")
        for library in (*(root / "lib").glob("*.so*"), *(root / SITE_PACKAGES).glob("ros_*.libs/*")):
            copy(library, prefix / "lib" / library.name)
    record = {
        name.parts[0]
        for info in (ours / SITE_PACKAGES).glob("ros_*.dist-info")
        if not info.name.startswith(NOT_ROS)
        for line in (info / "RECORD").read_text().splitlines()
        for name in [Path(line.split(",")[0])]
        if name.parts[0] != ".." and not name.parts[0].endswith((".dist-info", ".pth"))
    }
    for name in {*record, *OF_THE_DISTRIBUTION}:
        if (ours / SITE_PACKAGES / name).exists():
            copy(ours / SITE_PACKAGES / name, prefix / SITE_PACKAGES / name)
    merge(bundled_interfaces.site_packages(), prefix / SITE_PACKAGES)
    (prefix / SITE_PACKAGES / "launch").mkdir()
    (prefix / SITE_PACKAGES / "launch/__init__.py").touch()
    (prefix / "bin").mkdir()
    (prefix / "bin/ros2").write_text('#!/bin/sh\necho "the installed ros2 $*"\n')
    (prefix / "bin/ros2").chmod(0o755)
    return prefix


def sourced(prefix: Path, home: Path, **more: str) -> dict[str, str]:
    """The environment of a terminal in which the setup file of this prefix has been sourced."""
    return {
        "HOME": str(home),
        "TMPDIR": os.environ.get("TMPDIR", "/tmp"),
        "PATH": f"{prefix}/bin:{BASE_PYTHON.parent}:/usr/bin:/bin",
        "AMENT_PREFIX_PATH": str(prefix),
        "CMAKE_PREFIX_PATH": str(prefix),
        "LD_LIBRARY_PATH": f"{prefix}/lib",
        "PYTHONPATH": str(prefix / SITE_PACKAGES),
        "ROS_DISTRO": "jazzy",
        "ROS_VERSION": "2",
        "ROS_PYTHON_VERSION": "3",
        "SHELL": "/bin/sh",
        **more,
    }


def run(*words: str, env: Mapping[str, str], cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*TUTOR, *words], env=env, cwd=cwd, capture_output=True, text=True, timeout=100, check=False)


def test_its_ros_is_used_and_ours_is_on_none_of_its_paths(jazzy: Path, tmp_path: Path) -> None:
    env = sourced(jazzy, tmp_path)
    (tmp_path / "anywhere.py").write_text(RUN_ANYWHERE)
    ran = run("shell", "-c", "ros2 topic list; python3.12 anywhere.py", env=env, cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    said, places = ran.stdout.splitlines()
    assert said == "the installed ros2 topic list"
    modules = places.split(":")[:4]
    assert all(Path(module).is_relative_to(jazzy) for module in modules), modules
    ours = [place for place in places.split(":") if Path(place).is_relative_to(sys.prefix) or "bundled_ros" in place]
    assert not ours


def test_an_exercise_is_judged_on_it(jazzy: Path, tmp_path: Path) -> None:
    ran = run("check", "i1.3", "--solution", "--format", "json", env=sourced(jazzy, tmp_path), cwd=tmp_path)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert json.loads(ran.stdout)["environment"]["ros"] == "system"


def test_the_doctor_says_which_one_is_used(jazzy: Path, tmp_path: Path) -> None:
    said = " ".join(run("doctor", env=sourced(jazzy, tmp_path), cwd=tmp_path).stdout.split())
    assert "ROS 2 jazzy, system, rmw_fastrtps_cpp" in said
    assert "ROS 2 Jazzy is sourced" in said
    assert "those of the sourced ROS are used" in said


@pytest.mark.parametrize("distro", ["humble", "kilted", "lyrical"])
def test_another_distribution_is_named_in_one_line(jazzy: Path, tmp_path: Path, distro: str) -> None:
    env = sourced(jazzy, tmp_path, ROS_DISTRO=distro)
    assert detect(env).kind == "bundled"
    assert detect(env).problems == (f"ROS 2 {distro} is sourced (ROS_DISTRO={distro}); the exercises need jazzy.",)


def test_beside_another_distribution_the_bundled_one_is_used(jazzy: Path, tmp_path: Path) -> None:
    env = sourced(jazzy, tmp_path, ROS_DISTRO="kilted")
    ran = run("check", "i1.3", "--solution", "--format", "json", env=env, cwd=tmp_path)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert json.loads(ran.stdout)["environment"]["ros"] == "bundled"
