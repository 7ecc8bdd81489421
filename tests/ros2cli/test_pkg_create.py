"""ros2 pkg create, and the way from a new package to its running node."""

from __future__ import annotations

import argparse
import ast
import hashlib
import os
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from tests.ros2cli.bench import Bench, Ran
from tests.ros2cli.test_completion import complete
from tutor.bundled_ros.ros2.parsing import fill
from tutor.bundled_ros.ros2.pkg import create

RECORDED = tomllib.loads(Path(__file__).with_name("pkg_create.toml").read_text())
ADA = ("--maintainer-name", "Ada", "--maintainer-email", "ada@example.org")
PYTHON = ("--build-type", "ament_python")

CREATED = """\
going to create a new package
package name: my_pkg
destination directory: {here}/ws/src
package format: 3
version: 0.0.0
description: TODO: Package description
maintainer: ['Ada <ada@example.org>']
licenses: ['TODO: License declaration']
build type: ament_python
dependencies: ['rclpy', 'std_msgs']
node_name: my_node
creating folder ws/src/my_pkg
creating ws/src/my_pkg/package.xml
creating source folder
creating folder ws/src/my_pkg/my_pkg
creating ws/src/my_pkg/setup.py
creating ws/src/my_pkg/setup.cfg
creating folder ws/src/my_pkg/resource
creating ws/src/my_pkg/resource/my_pkg
creating ws/src/my_pkg/my_pkg/__init__.py
creating folder ws/src/my_pkg/test
creating ws/src/my_pkg/test/test_copyright.py
creating ws/src/my_pkg/test/test_flake8.py
creating ws/src/my_pkg/test/test_pep257.py
creating ws/src/my_pkg/my_pkg/my_node.py

[WARNING]: Unknown license 'TODO: License declaration'.  This has been set in the package.xml, but no \
LICENSE file has been created.
It is recommended to use one of the ament license identifiers:
Apache-2.0
BSL-1.0
BSD-2.0
BSD-2-Clause
BSD-3-Clause
GPL-3.0-only
LGPL-3.0-only
MIT
MIT-0
"""

TALKER = """\
import rclpy
def main():
    rclpy.init()
    print("talking as", rclpy.create_node("talker").get_name())
"""


@pytest.fixture(scope="module")
def workspace(module_bench: Bench) -> Bench:
    """A bench whose workspace has a new package, `my_pkg` with `my_node`."""
    src = module_bench.folder / "ws" / "src"
    src.mkdir(parents=True)
    options = ("--node-name", "my_node", "--dependencies", "rclpy", "std_msgs", "--destination-directory", "ws/src")
    ran = module_bench.ros2("pkg", "create", *PYTHON, "my_pkg", *options, *ADA)
    assert ran == Ran(CREATED.format(here=module_bench.folder), "", 0)
    return module_bench


def run(*words: str) -> None:
    parser = argparse.ArgumentParser()
    fill(parser, create.GRAMMAR["create"])
    arguments = parser.parse_args(words)
    arguments.run(arguments)


@pytest.mark.parametrize("line", RECORDED)
def test_packages_are_those_of_the_real_command(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    run(*line.split(), *ADA)
    captured = capsys.readouterr()
    digest = hashlib.sha256(captured.out.replace(str(tmp_path), "HERE").encode())
    files = {str(path.relative_to(tmp_path)): path for path in tmp_path.rglob("*") if path.is_file()}
    for name in sorted(files):
        digest.update(name.encode() + b"\0" + files[name].read_bytes() + b"\0")
    assert (digest.hexdigest()[:16], captured.err) == (RECORDED[line], ""), captured.out


def test_a_new_packages_node_runs_from_any_folder_without_a_build(workspace: Bench) -> None:
    assert workspace.ros2("run", "my_pkg", "my_node") == Ran("Hi from my_pkg.\n", "", 0)
    assert workspace.ros2("pkg", "executables", "my_pkg").stdout == "my_pkg my_node\n"
    assert "my_pkg" in workspace.ros2("pkg", "list").stdout.split()
    assert workspace.ros2("pkg", "prefix", "my_pkg").stdout == f"{workspace.folder}/ws/src/my_pkg\n"
    assert workspace.ros2("pkg", "xml", "my_pkg", "-t", "name").stdout == "my_pkg\n"
    assert "my_pkg" in complete(workspace, "ros2 run my")


def test_a_node_added_as_in_the_tutorial_is_found(workspace: Bench) -> None:
    package = workspace.folder / "ws" / "src" / "py_pubsub"
    assert workspace.ros2("pkg", "create", *PYTHON, package.name, "--destination-directory", "ws/src").code == 0
    (package / "py_pubsub" / "publisher_member_function.py").write_text(TALKER)
    setup = package / "setup.py"
    setup.write_text(
        setup.read_text().replace(
            "'console_scripts': [\n",
            "'console_scripts': [\n            'talker = py_pubsub.publisher_member_function:main',\n",
        )
    )
    assert workspace.ros2("run", "py_pubsub", "talker") == Ran("talking as talker\n", "", 0)


def test_setuptools_builds_the_package_where_ros2_run_looks_for_it(workspace: Bench) -> None:
    pytest.importorskip("setuptools")
    package = workspace.folder / "ws" / "src" / "my_pkg"
    where = workspace.folder / "build"
    subprocess.run(
        [sys.executable, "-W", "ignore", "setup.py", "-q", "egg_info", "--egg-base", where, "build", "-b", where],
        cwd=package, check=True, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}, preexec_fn=where.mkdir,
    )  # fmt: skip
    assert sorted(path.name for path in (where / "lib" / "my_pkg").iterdir()) == ["__init__.py", "my_node.py"]
    entry_points = (where / "my_pkg.egg-info" / "entry_points.txt").read_text()
    assert entry_points == "[console_scripts]\nmy_node = my_pkg.my_node:main\n"


def test_what_cannot_be_created_is_said_as_by_the_real_command(workspace: Bench) -> None:
    (workspace.folder / "taken").mkdir()
    assert workspace.ros2("pkg", "create", "taken") == Ran(
        "",
        "\nAborted!\nThe directory already exists: ./taken\n"
        "Either remove the directory or choose a different destination directory or package name\n",
        1,
    )
    assert workspace.ros2("pkg", "create", "test", *PYTHON) == Ran(
        "",
        "Aborted since 'ament_python' packages can't be named 'test'. Please choose a different package name.\n",
        1,
    )
    unnamed = workspace.ros2("pkg", "create", *PYTHON)
    assert (unnamed.stdout, unnamed.code) == ("", 2)
    assert unnamed.stderr.endswith("ros2 pkg create: error: the following arguments are required: package_name\n")
    unknown = workspace.ros2("pkg", "create", "--build-type", "ament-python", "p")
    assert unknown.stderr.endswith(
        "ros2 pkg create: error: argument --build-type: invalid choice: 'ament-python' "
        "(choose from 'cmake', 'ament_cmake', 'ament_python')\n"
    )
    (workspace.folder / "file").touch()
    blocked = workspace.ros2("pkg", "create", "p", "--destination-directory", "file")
    assert (blocked.stderr, blocked.code) == ("cannot create file/p: Not a directory\n", 1)


def test_licenses_are_listed(workspace: Bench) -> None:
    ran = workspace.ros2("pkg", "create", "p", "--license", "?")
    assert ran.stdout.startswith("Supported licenses:\nApache-2.0\nBSL-1.0\n")
    assert (ran.stdout.count("\n"), ran.stderr, ran.code) == (10, "", 0)
    assert not (workspace.folder / "p").exists()


def test_a_node_named_as_the_library_is_renamed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run("p", "--destination-directory", str(tmp_path), "--node-name", "same", "--library-name", "same", *ADA)
    captured = capsys.readouterr()
    assert captured.err == (
        "[WARNING] node name can not be equal to the library name\n[WARNING] renaming node to same_node\n"
    )
    assert "node_name: same_node\nlibrary_name: same\n" in captured.out
    assert {path.name for path in (tmp_path / "p" / "src").iterdir()} == {"same.cpp", "same_node.cpp"}


def test_the_maintainer_is_who_git_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    config = tmp_path / "gitconfig"
    config.write_text("[user]\n    email = ada@lovelace.example\n")
    monkeypatch.setenv("LOGNAME", "ada")
    monkeypatch.setenv("GIT_CONFIG_NOSYSTEM", "1")
    monkeypatch.chdir(tmp_path)
    for global_config, email in ((config, "ada@lovelace.example"), (os.devnull, "ada@todo.todo")):
        monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(global_config))
        run(email.partition("@")[2].replace(".", "_"))
        assert f"maintainer: ['ada <{email}>']\n" in capsys.readouterr().out


@pytest.mark.parametrize("description", ["Ada's \\ first", "a < b & c", 'the "first"', "1 &lt; 2"])
def test_any_description_leaves_the_files_sound(description: str, tmp_path: Path) -> None:
    run("p", *PYTHON, "--destination-directory", str(tmp_path), "--description", description, *ADA)
    ET.parse(tmp_path / "p" / "package.xml")
    ast.parse((tmp_path / "p" / "setup.py").read_text())


def test_options_and_their_values_are_completed(workspace: Bench) -> None:
    assert complete(workspace, "ros2 pkg cr") == ["create"]
    assert complete(workspace, "ros2 pkg create --build-type ament_") == ["ament_cmake", "ament_python"]
    assert complete(workspace, "ros2 pkg create --license BSD-3") == ["BSD-3-Clause"]
    assert "std_msgs" in complete(workspace, "ros2 pkg create p --dependencies std")
    assert complete(workspace, "ros2 pkg create --maintainer-n") == ["--maintainer-name"]
