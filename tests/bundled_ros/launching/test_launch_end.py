"""How a launch ends: on Ctrl+C in its forms and on SIGTERM, and without orphans (which the launcher looks for)."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import pytest

from tests.bundled_ros.launching.case import launch_file
from tests.bundled_ros.launching.launcher import Launcher, Ran
from tests.ros.ordinary_domain import ordinary_domain
from tutor import interpreter, private_folders

LIMIT_S = 60.0
WAITER = "Node(package='demo', executable='waiter', output='screen')"
INTERRUPTED = "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)"


def write(launcher: Launcher, actions: str, before: str = "") -> Path:
    path = launcher.folder / "main.launch.py"
    path.write_text(launch_file(actions, before))
    return path


def shut_down_cleanly(ran: Ran) -> bool:
    return ran.code == 0 and not ran.has_orphans and ran.printed == {"waiter-1": ("ready", "interrupted")}


def test_ctrl_c_sent_to_the_launch_alone_reaches_the_nodes(launcher: Launcher) -> None:
    ran = launcher.run(write(launcher, WAITER), interrupt_at="ready")
    assert shut_down_cleanly(ran), ran
    assert "[INFO] [waiter-1]: sending signal 'SIGINT' to process[waiter-1]" in ran.log


def test_ctrl_c_in_a_terminal_reaches_each_node_once(launcher: Launcher) -> None:
    ran = launcher.run(write(launcher, WAITER), options="terminal", interrupt_at="ready", to_all=True)
    assert shut_down_cleanly(ran), ran
    assert INTERRUPTED in ran.log
    assert not any("sending signal" in line for line in ran.log)


def test_ctrl_c_ends_a_launch_in_the_background(launcher: Launcher) -> None:
    # A shell starts background jobs with SIGINT ignored; neither the launch nor its nodes may inherit that.
    ran = launcher.run(write(launcher, WAITER), interrupt_at="ready", ignoring_sigint=True)
    assert shut_down_cleanly(ran), ran


def test_a_second_ctrl_c_is_ignored(launcher: Launcher) -> None:
    stubborn = "Node(package='demo', executable='stubborn', output='screen', sigterm_timeout='0.5')"
    path = write(launcher, f"{stubborn}, RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg='shutting down')]))")
    ran = launcher.run(path, interrupt_at="ready", signals=(signal.SIGINT,))
    assert ran.log.count(INTERRUPTED) == 1
    twice = launcher.run(path, interrupt_at="ready", signals=(signal.SIGINT, signal.SIGINT))
    assert twice.printed == {"stubborn-1": ("ready", "terminated")}
    assert (twice.code, twice.has_orphans) == (0, False)


def test_ctrl_c_ends_a_process_run_in_a_shell(launcher: Launcher) -> None:
    command = (
        f"ExecuteProcess(cmd=['exec', '{launcher.prefix}/lib/demo/waiter'], shell=True, output='screen', name='waiter')"
    )
    assert shut_down_cleanly(launcher.run(write(launcher, command), interrupt_at="ready"))


def test_ctrl_c_during_a_respawn_delay(launcher: Launcher) -> None:
    path = write(launcher, "ExecuteProcess(cmd=['echo', 'once'], output='screen', respawn=True, respawn_delay=30.0)")
    ran = launcher.run(path, interrupt_at="finished cleanly")
    assert ran.printed == {"echo-1": ("once",)}
    assert (ran.code, ran.has_orphans) == (0, False)


def test_ctrl_c_right_at_the_start(launcher: Launcher) -> None:
    before = "import os, signal\n"
    raised = "OpaqueFunction(function=lambda context: os.kill(os.getpid(), signal.SIGINT))"
    ran = launcher.run(write(launcher, f"{WAITER}, {raised}", before), options="terminal")
    assert INTERRUPTED in ran.log
    assert (ran.code, ran.has_orphans) == (0, False)


def test_two_signals_interrupt_an_endless_function_of_the_launch_file(launcher: Launcher) -> None:
    before = "import time\ndef forever(context):\n    print('stuck', flush=True)\n    while True:\n        "
    "time.sleep(0.01)\n"
    path = write(launcher, "OpaqueFunction(function=forever), LogInfo(msg='never')", before)
    # Two equal signals at once may be delivered as one.
    ran = launcher.run(path, interrupt_at="stuck", signals=(signal.SIGINT, signal.SIGTERM))
    assert "never" not in "\n".join(ran.lines)
    assert (ran.code, ran.has_orphans) == (1, False)


def test_sigterm_ends_the_nodes_too(launcher: Launcher) -> None:
    ran = launcher.run(write(launcher, WAITER), interrupt_at="ready", signals=(signal.SIGTERM,))
    assert "[ERROR] [launch]: user interrupted with ctrl-\\ (SIGTERM), terminating..." in ran.log
    assert (ran.code, ran.has_orphans) == (1, False)


def test_sigterm_ends_even_a_node_that_ignores_it(launcher: Launcher) -> None:
    path = write(launcher, "Node(package='demo', executable='immortal', output='screen')")
    ran = launcher.run(path, interrupt_at="ready", signals=(signal.SIGTERM,))
    assert (ran.code, ran.has_orphans) == (1, False)


def test_parameter_files_are_removed_at_the_end(launcher: Launcher) -> None:
    before = "import tempfile\ntempfile.tempdir = os.path.dirname(os.path.abspath(__file__))\n"
    node = "Node(package='demo', executable='talker', parameters=[{'a': 1}], output='screen')"
    ran = launcher.run(write(launcher, node, before))
    assert "param     a: 1" in ran.printed["talker-1"]
    assert not list(launcher.folder.glob("launch_params_*"))


def test_parameter_files_of_a_killed_launch_are_removed_at_the_next_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    path = tmp_path / "one.launch.py"
    path.write_text(
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([Node(package='demo_nodes_py', executable='talker', parameters=[{'a': 1}])])\n"
    )
    with ordinary_domain() as domain:
        env = {**os.environ, "TMPDIR": str(temporary), "ROS_DOMAIN_ID": str(domain)}
        launch = subprocess.Popen(
            interpreter.module_command("tutor", "ros2", "launch", str(path)),
            env=env, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, process_group=0,
        )  # fmt: skip
        try:
            deadline = time.monotonic() + LIMIT_S
            while not (leftovers := list(temporary.rglob("launch_params_*"))):
                assert time.monotonic() < deadline
                time.sleep(0.05)
        finally:
            os.killpg(launch.pid, signal.SIGKILL)
            launch.wait()
    assert all(each.exists() for each in leftovers)
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    with private_folders.temporary("check"):
        assert not list(temporary.rglob("launch_params_*"))
