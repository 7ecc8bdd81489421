"""What a release consists of. `packaging/try_install` installs it for real."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Sequence
from importlib import util
from pathlib import Path
from types import ModuleType

import pytest

from tutor import __version__
from tutor.doctor import machine
from tutor.ros.environment import detect, learner_env

CLONE = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((CLONE / "pyproject.toml").read_text())["project"]
RECORD = f"ros_tutor-{__version__}.dist-info"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built from the clone, where the messages are compiled already."""
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "hatchling", "build", "--target", "wheel", "--directory", str(folder)]
    built = subprocess.run(command, cwd=CLONE, capture_output=True, text=True, timeout=100, check=False)
    assert built.returncode == 0, built.stderr
    (path,) = folder.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The `bin` of an environment with the wheel, what it requires, and another project's package `tutor`."""
    root = tmp_path_factory.mktemp("installed")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", root], check=True)
    (site,) = root.glob("lib/python3.*/site-packages")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    script = root / "bin/ros-tutor"
    (site / f"ros_tutor-{__version__}.data/scripts/ros-tutor").rename(script)
    script.chmod(0o755)
    (site / "ros_tutor/tutor/__pycache__").mkdir()  # else the first start compiles in the background
    (site / "tutor").mkdir()
    (site / "tutor/__init__.py").write_text("raise ImportError('this is another project')")
    (site / "required.pth").write_text(str(Path(util.find_spec("argcomplete").origin).parents[1]))  # type: ignore[union-attr,arg-type]
    return root / "bin"


def run(*command: str | Path, **env: str) -> subprocess.CompletedProcess[str]:
    given = {"PATH": os.environ["PATH"], "HOME": "/nonexistent", "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1", **env}
    return subprocess.run(command, cwd="/", env=given, capture_output=True, text=True, timeout=60, check=False)


def test_all_is_in_one_folder(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    data = f"ros_tutor-{__version__}.data"
    assert {name.partition("/")[0] for name in names} == {"ros_tutor", RECORD, data}
    assert [name for name in names if name.startswith(data)] == [f"{data}/scripts/ros-tutor"]
    inside = [name.removeprefix("ros_tutor/") for name in names if name.startswith("ros_tutor/")]
    assert {name.partition("/")[0] for name in inside} == {"tutor", "checks", "lessons"}
    assert "lessons/i1_1/lesson.md" in inside
    assert [name for name in inside if name.startswith("tutor/bundled_ros/prefix/") and name.endswith(".so")]
    assert [name for name in inside if name.startswith("tutor/bundled_ros/interfaces/")] == []


def test_its_page_on_the_index_has_what_one_looks_for(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        metadata = archive.read(f"{RECORD}/METADATA").decode()
    head, _, description = metadata.partition("\n\n")
    for line in (
        f"Version: {__version__}",
        "License-Expression: Apache-2.0",
        "Description-Content-Type: text/markdown",
    ):
        assert line in head.splitlines()
    assert "\nAuthor: " in head
    assert "\nProject-URL: Source, https://" in head
    links: list[str] = re.findall(r"\]\(([^)]+)\)", description)
    assert links
    assert [link for link in links if not link.startswith(("https://", "#"))] == []


def test_the_version_is_in_one_place() -> None:
    assert "version" not in PROJECT
    assert "version" in PROJECT["dynamic"]
    assert f"## {__version__}\n" in (CLONE / "CHANGELOG.md").read_text()
    lock = tomllib.loads((CLONE / "uv.lock").read_text())
    (ours,) = (package for package in lock["package"] if package["name"] == "ros-tutor")
    assert "version" not in ours


def test_the_pythons_are_the_same_wherever_they_are_named() -> None:
    prefix = "Programming Language :: Python :: 3."
    named = [line.removeprefix(prefix) for line in PROJECT["classifiers"] if line.startswith(prefix)]
    assert PROJECT["requires-python"] == f">=3.{named[0]},<3.{int(named[-1]) + 1}"
    assert [machine.python_version((3, int(minor)), "Linux x86_64").ok for minor in named] == [True] * len(named)
    release = (CLONE / ".github/workflows/release.yml").read_text()
    build = (CLONE / "packaging/build").read_text()
    for minor in named:
        assert f"/opt/python/cp3{minor}-cp3{minor}/bin/python" in release
        assert f'"3.{minor}"' in release
        assert f" 3.{minor}" in build


def test_the_program_runs_beside_another_tutor(installed: Path) -> None:
    done = run(installed / "ros-tutor", "--version")
    assert (done.returncode, done.stdout) == (0, f"ros-tutor {__version__}\n"), done.stderr
    done = run(installed / "ros-tutor", "list", PYTHONPATH="/nonexistent:.")
    assert done.returncode == 0, done.stderr
    assert "Sensor Publisher" in done.stdout


def test_what_it_starts_finds_our_packages_and_a_learners_program_does_not(installed: Path, tmp_path: Path) -> None:
    ours = "from tutor.interpreter import module_command as m; from tutor.bundled_ros.ros2 import starting as s;"
    ours += "from tutor.ros.environment import detect as d; print(*m('tutor.engine'), sep='\\n');"
    ours += "print('--', *s.ros2_command(d({}), {}), sep='\\n')"
    (folder,) = installed.parent.glob("lib/python3.*/site-packages/ros_tutor")
    told = run(installed / "python", "-c", ours, PYTHONPATH=str(folder))
    assert told.returncode == 0, told.stderr
    engine, ros2 = (part.splitlines() for part in told.stdout.split("--\n"))
    assert run(*engine, "--help").returncode == 0
    assert "topic" in run(*ros2, "--help").stdout
    program = tmp_path / "node.py"
    program.write_text(
        "import importlib.util as u; print([n for n in ('checks', 'lessons') if u.find_spec(n)]); import tutor"
    )
    done = run(installed / "python", program)
    assert done.stdout == "[]\n"
    assert "this is another project" in done.stderr


def test_no_folder_on_the_path_of_a_learners_program_holds_our_packages(tmp_path: Path) -> None:
    for isolated in (True, False):
        env = learner_env(detect({}), domain_id=1, log_dir=tmp_path, package_root=None, isolated=isolated, environ={})
        assert [entry for entry in env["PYTHONPATH"].split(":") if (Path(entry) / "tutor").exists()] == []


def test_without_an_environment_of_its_own_it_says_what_to_do(tmp_path: Path) -> None:
    script = tmp_path / "ros-tutor"
    script.write_bytes((CLONE / "packaging/ros-tutor").read_bytes())
    done = run("sh", script)
    assert (done.returncode, done.stdout) == (3, "")
    assert "uv tool install ros-tutor" in done.stderr


@pytest.fixture
def hook() -> ModuleType:
    spec = util.spec_from_file_location("hatch_build", CLONE / "tutor/bundled_ros/interfaces/hatch_build.py")
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("attributes", "says"),
    [
        ({"machine": "aarch64"}, ("Linux on aarch64", "use a container")),
        ({"system": "Darwin", "machine": "arm64", "libc_ver": ("", "")}, ("Darwin on arm64", "virtual machine")),
        ({"libc_ver": ("", "")}, ("another C library", "glibc 2.28 or later")),
        ({"libc_ver": ("glibc", "2.17")}, ("with glibc 2.17", "glibc 2.28 or later")),
        ({"python_implementation": "PyPy"}, ("PyPy 3.", "uv tool install --python 3.12 ros-tutor")),
        ({"requires": "==3.99.*"}, ("it needs CPython 3.99", "install it with another one")),
        ({}, ()),
    ],
)
def test_a_machine_or_python_that_cannot_be_served_is_told_in_one_sentence(
    attributes: dict[str, object], says: Sequence[str], hook: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = {"system": "Linux", "machine": "x86_64", "libc_ver": ("glibc", "2.36"), **attributes}
    requires = given.pop("requires", PROJECT["requires-python"])
    for name, value in given.items():
        monkeypatch.setattr(hook.platform, name, lambda value=value: value)
    told = hook.why_not_here(requires)
    assert bool(told) is bool(says)
    assert [text for text in says if text not in told] == []
    assert ". " not in told
