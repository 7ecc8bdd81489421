"""Packages that exist only as sources are found like built ones."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2 import overlay, sources
from tutor.ros.prefixes import PACKAGE_INDEX

SETUP = """
from setuptools import find_packages, setup
package_name = "birds"
{before}
setup(name=package_name, packages=find_packages(), entry_points={{"console_scripts": {scripts}}})
"""
MODULE = 'import sys\ndef main():\n    print("{}", *sys.argv[1:])\n    return 7\n'


def write_file(path: Path, text: str = "") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def write_package(folder: Path, name: str, scripts: str = "[]", before: str = "") -> Path:
    """Write a source package with one module, `sing`, into a folder of its name."""
    root = folder / name
    write_file(root / "package.xml", f"<package><name>{name}</name></package>")
    write_file(root / "setup.py", SETUP.format(scripts=scripts, before=before))
    write_file(root / name / "__init__.py")
    write_file(root / name / "sing.py", MODULE.format(name))
    return root


UseOverlay = Callable[[Path | None], None]


@pytest.fixture
def use_overlay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> UseOverlay:
    """Return a function that creates and activates an overlay for a launch file. There is no workspace."""
    monkeypatch.setenv("ROS_TUTOR_WORKSPACE", str(tmp_path / "no-workspace"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", "")

    def use_overlay(near: Path | None) -> None:
        environ = dict(os.environ)
        overlay.make_overlay(tmp_path / "overlay", near, environ)
        for name in ("AMENT_PREFIX_PATH", "PYTHONPATH", "PATH"):
            monkeypatch.setenv(name, environ.get(name, ""))

    return use_overlay


def run(package: str, executable: str, *arguments: str) -> tuple[int, str]:
    ran = subprocess.run(
        [*packages.find_executable(package, executable), *arguments], capture_output=True, text=True, check=False
    )
    assert not ran.stderr
    return ran.returncode, ran.stdout.strip()


def test_demo_nodes_and_my_package_are_always_available(use_overlay: UseOverlay) -> None:
    use_overlay(None)
    assert packages.packages_with_executables() == ["demo_nodes_cpp", "demo_nodes_py", "my_package"]
    for name, programs in (("demo_nodes_py", ("talker", "listener")), ("my_package", ("minimal_publisher",))):
        for program in programs:
            assert Path(packages.find_executable(name, program)[-1]).is_file()
    assert (packages.find_share("demo_nodes_cpp") / "launch/topics/talker_listener_launch.py").is_file()


def test_errors_for_missing_names_list_what_exists(use_overlay: UseOverlay) -> None:
    use_overlay(None)
    with pytest.raises(packages.PackageNotFound, match="not found; is it demo_nodes_py or demo_nodes_cpp"):
        packages.find_executable("demo_nodes", "talker")
    with pytest.raises(
        packages.ExecutableNotFound, match="'talk' not found in package 'demo_nodes_py'; it has: listener, talker"
    ):
        packages.find_executable("demo_nodes_py", "talk")
    for name in ("", "..", str(Path(__file__).parent), __file__):
        assert not packages.has_package(name)
        with pytest.raises(LookupError):
            packages.find_share(name)


def test_modules_beside_a_launch_file_belong_to_my_package(use_overlay: UseOverlay, tmp_path: Path) -> None:
    own = write_file(tmp_path / "own/my_launch.py").parent
    write_file(own / "greet.py", MODULE.format("hello"))
    write_file(own / "minimal_publisher.py", "from my_package.greet import main\n# def main(\n")
    write_file(own / "no_program.py", "x = 1\n")
    write_file(own / "params.yaml", "a: 1")
    use_overlay(own / "my_launch.py")
    assert run("my_package", "greet", "you") == (7, "hello you")
    assert run("my_package", "minimal_publisher") == (7, "hello")
    with pytest.raises(packages.ExecutableNotFound):
        packages.find_executable("my_package", "no_program")
    share = packages.find_share("my_package")
    assert (share / "launch/my_launch.py").is_file()
    assert (share / "config/params.yaml").is_file()


@pytest.mark.parametrize(
    ("scripts", "before"),
    [
        ('["sing = birds.sing:main"]', ""),
        ('["sing=birds.sing:main", "other = birds.other:main"]', ""),
        ('[f"sing = {package_name}.sing:main"]', ""),
        ('["sing = " + package_name + ".sing:main"]', ""),
        ('[f"{each} = birds.{each}:main" for each in found]', "found = ['sing']"),
        ('[f"{p.stem} = birds.{p.stem}:main" for p in Path("birds").glob("s*.py")]', "from pathlib import Path"),
    ],
)
def test_console_scripts_in_setup_py_are_found(
    use_overlay: UseOverlay, tmp_path: Path, scripts: str, before: str
) -> None:
    write_package(tmp_path / "ws", "birds", scripts, before)
    use_overlay(write_file(tmp_path / "ws/birds/launch/my_launch.py"))
    assert run("birds", "sing", "loud") == (7, "birds loud")


def test_setup_py_is_not_run_if_it_can_be_parsed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*arguments: object, **options: object) -> None:
        raise AssertionError("it was run")

    monkeypatch.setattr(subprocess, "run", never)
    folder = write_package(tmp_path, "birds", '["sing = birds.sing:main"]')
    assert [dict(each.programs) for each in sources.workspace_packages(folder)] == [{"sing": "sing:main"}]
    assert set(sources.template_package().programs) == {"minimal_publisher", "minimal_subscriber"}


@pytest.mark.parametrize("text", ["setup(", "raise SystemExit(3)", "import nowhere\nsetup(entry_points=x())"])
def test_a_broken_setup_py_breaks_nothing_else(use_overlay: UseOverlay, tmp_path: Path, text: str) -> None:
    root = write_package(tmp_path / "ws", "birds")
    write_file(root / "setup.py", text)
    use_overlay(write_file(tmp_path / "ws/birds/launch/my_launch.py"))
    assert packages.has_package("birds")
    assert packages.has_package("demo_nodes_py")


def test_console_scripts_in_setup_cfg_are_found(use_overlay: UseOverlay, tmp_path: Path) -> None:
    root = write_package(tmp_path / "ws", "birds")
    write_file(root / "setup.py", "from setuptools import setup\nsetup()\n")
    write_file(root / "setup.cfg", "[options.entry_points]\nconsole_scripts =\n    sing = birds.sing:main\n")
    use_overlay(write_file(root / "launch/my_launch.py"))
    assert run("birds", "sing") == (7, "birds")


def test_all_packages_of_the_workspace_are_found_before_the_template(use_overlay: UseOverlay, tmp_path: Path) -> None:
    ws = tmp_path / "ws"
    write_package(ws / "src", "birds", '["sing = birds.sing:main"]')
    write_package(ws / "src", "my_package", '["only = my_package.sing:main"]')
    launch = write_file(ws / "src/birds/launch/my_launch.py")
    (ws / ".ros-tutor").mkdir()
    use_overlay(launch)
    assert run("birds", "sing") == (7, "birds")
    assert run("my_package", "only") == (7, "my_package")
    with pytest.raises(packages.ExecutableNotFound, match="it has: only"):
        packages.find_executable("my_package", "minimal_publisher")


def test_a_package_beside_the_launch_file_is_found(use_overlay: UseOverlay, tmp_path: Path) -> None:
    write_package(tmp_path / "own", "birds", '["sing = birds.sing:main"]')
    use_overlay(write_file(tmp_path / "own/my_launch.py"))
    assert run("birds", "sing") == (7, "birds")


def test_installed_packages_take_precedence(
    use_overlay: UseOverlay, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = tmp_path / "real with spaces"
    write_file(real / PACKAGE_INDEX / "demo_nodes_py")
    program = write_file(real / "lib/demo_nodes_py/talker", "#!/bin/sh\necho real\nexit 3\n")
    program.chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(real))
    environ = dict(os.environ)
    overlay.make_overlay(tmp_path / "overlay", None, environ)
    monkeypatch.setenv("AMENT_PREFIX_PATH", environ["AMENT_PREFIX_PATH"])
    assert packages.find_executable("demo_nodes_py", "talker") == [str(program)]
    assert run("demo_nodes_py", "talker") == (3, "real")
    ours = [str(tmp_path / "overlay/lib/demo_nodes_cpp/talker")]
    assert packages.find_executable("demo_nodes_cpp", "talker") == ours
    monkeypatch.setattr(sys, "executable", "/with spaces/python")  # a path that a shebang line cannot hold
    monkeypatch.setattr(packages, "_interpreter_line", lambda program: "/with spaces/python -P")
    assert packages.find_executable("demo_nodes_cpp", "talker") == ["/with spaces/python", "-P", *ours]


def test_our_ros2_is_added_to_the_path_if_there_is_none(tmp_path: Path) -> None:
    environ = {"PATH": "/nowhere"}
    overlay.make_overlay(tmp_path / "ours", None, environ)
    assert environ["PATH"].split(os.pathsep)[-1] == str(tmp_path / "ours/bin")
    real = write_file(tmp_path / "real/ros2")
    real.chmod(0o755)
    environ = {"PATH": str(real.parent)}
    overlay.make_overlay(tmp_path / "theirs", None, environ)
    assert environ["PATH"] == str(real.parent)


def test_packages_are_found_at_any_depth_but_not_inside_others(use_overlay: UseOverlay, tmp_path: Path) -> None:
    ws = tmp_path / "ws"
    scripts = "['sing = {0}.sing:main']"
    for name, at in (
        ("near", "src"),
        ("deep", "src/group/sub"),
        ("inner", "src/near"),
        ("built", "build"),
        ("off", "src/x"),
    ):
        write_package(ws / at, name, scripts.format(name))
    write_file(ws / "src/x/COLCON_IGNORE")
    use_overlay(write_file(ws / "src/near/launch/a.launch.py"))
    assert run("near", "sing") == (7, "near")
    assert run("deep", "sing") == (7, "deep")
    assert not any(map(packages.has_package, ("inner", "built", "off")))


def test_a_folder_that_is_not_a_workspace_is_not_searched_deeply(use_overlay: UseOverlay, tmp_path: Path) -> None:
    home = tmp_path / "home"
    for name, at in (("near", "a"), ("far", "b/c/d")):
        write_package(home / at, name)
    use_overlay(write_file(home / "my_launch.py"))
    assert packages.has_package("near")
    assert not packages.has_package("far")


def test_unbuilt_demo_nodes_cpp_do_not_hide_ours(use_overlay: UseOverlay, tmp_path: Path) -> None:
    write_file(tmp_path / "ws/src/demos/demo_nodes_cpp/package.xml", "<package><name>demo_nodes_cpp</name></package>")
    write_file(tmp_path / "ws/src/demos/demo_nodes_cpp/CMakeLists.txt")
    use_overlay(write_file(write_package(tmp_path / "ws/src", "birds") / "launch/a.launch.py"))
    assert packages.find_executable("demo_nodes_cpp", "talker")


def test_a_program_that_colcon_built_for_its_own_python_runs_with_the_bundled_ros(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    write_file(tmp_path / PACKAGE_INDEX / "built")
    lines = {
        "colcons": f"#!{tmp_path}/venv/bin/python3.12\n",
        "systems": "#!/usr/bin/python3\n",
        "users": f"#!{tmp_path}/with-rclpy/bin/python3\n",
        "chosen": "#!/usr/bin/env python3\n",
        "shell": "#!/bin/sh\n",
    }
    (tmp_path / "with-rclpy/lib/python3.12/site-packages/rclpy").mkdir(parents=True)
    for name, line in lines.items():
        write_file(tmp_path / "lib/built" / name, line).chmod(0o755)
    with_ours = {name for name in lines if packages.find_executable("built", name)[0] == sys.executable}
    assert with_ours == {"colcons", "systems"}
