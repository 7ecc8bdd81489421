"""The ros2 command, run as a process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import pytest

from tests.ros2cli.bench import Bench, command
from tutor import bundled_ros

LIMIT_S = 60
LAUNCH_FILE = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("word", default_value="nothing", description="What to say"),
        ExecuteProcess(cmd=["echo", "said", LaunchConfiguration("word")], output="screen"),
    ])
"""


@contextmanager
def start(bench: Bench, *words: str) -> Iterator[subprocess.Popen[str]]:
    """Start `ros2` in its own process group, which is killed after the block."""
    process = subprocess.Popen(
        command(*words),
        env=bench.env,
        cwd=bench.folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        process_group=0,
    )
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def read_until(process: subprocess.Popen[str], *words: str) -> str:
    """Read up to the first line that contains all these words, and return it."""
    assert process.stdout is not None
    deadline, seen = time.monotonic() + LIMIT_S, []
    for line in process.stdout:
        seen.append(line)
        if all(word in line for word in words):
            return line
        assert time.monotonic() < deadline, seen
    raise AssertionError(seen)


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["bag", "record"], 2, "`ros2 bag` needs an installed ROS 2; this ros2 knows: "),
        (["run", "demo", "talker"], 1, "Package 'demo' not found\n"),
        (["run", "demo_nodes_py", "shout"], 1, "No executable found\n"),
        (["launch", "nowhere.py"], 1, "there is no launch file nowhere.py"),
        (["launch", "my_package"], 1, "say which launch file of my_package"),
        (
            ["launch", "my_package", "nowhere.py"],
            1,
            "file 'nowhere.py' was not found in the share directory of package 'my_package' which is at '",
        ),
        (["launch", "demo", "my_launch.py"], 1, "Package 'demo' not found: \"package 'demo' not found, searching: ['"),
        (["launch", "my_launch.py", "word=x"], 1, "malformed launch argument 'word=x'"),
        (["launch", "my_launch.py", "word:="], 1, "malformed launch argument 'word:='"),
    ],
)
def test_errors_are_reported_in_one_line(bench: Bench, words: list[str], code: int, message: str) -> None:
    (bench.folder / "my_launch.py").write_text(LAUNCH_FILE)
    ran = bench.ros2(*words)
    assert ran.code == code
    assert message in ran.stderr
    assert ran.stderr.count("\n") == 1
    assert not list((bench.folder / "log").rglob("ros2-overlay*"))


@pytest.mark.parametrize(
    ("words", "suggestion"),
    [
        (["run", "demo_nodes_py", "taker"], "No executable found (is it talker?)"),
        (["run", "demo_node_py", "talker"], "Package 'demo_node_py' not found (is it demo_nodes_py"),
        (["launch", "demo_nodes_cpp", "talker_listener.py"], "(is it talker_listener_launch"),
    ],
)
def test_a_misspelled_name_gets_a_suggestion(bench: Bench, words: list[str], suggestion: str) -> None:
    ran = bench.ros2(*words)
    assert (ran.code, ran.stderr.count("\n")) == (1, 1)
    assert suggestion in ran.stderr


@pytest.mark.parametrize("code", [0, 3, -9])
def test_run_reports_how_a_program_failed(bench: Bench, code: int) -> None:
    module = bench.folder / "ws/src/birds/birds/sing.py"
    module.parent.mkdir(parents=True)
    (module.parent / "__init__.py").touch()
    module.write_text(f"import os, sys\ndef main():\n    os.kill(os.getpid(), {max(-code, 0)})\n    return {code}\n")
    (module.parents[1] / "package.xml").write_text("<package><name>birds</name></package>")
    (module.parents[1] / "setup.cfg").write_text(
        "[options.entry_points]\nconsole_scripts =\n  sing = birds.sing:main\n"
    )
    ran = replace(bench, folder=bench.folder / "ws").ros2("run", "--prefix", "env A=b", "birds", "sing")
    message = {0: "", 3: "[ros2run]: Process exited with failure 3\n", -9: "[ros2run]: Killed\n"}
    assert (ran.stdout, ran.stderr, ran.code) == (message[code], "", code % 256)


LAUNCH_FILE_WITH_HANDLER = """
import os
from launch import LaunchDescription
from launch.actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch_ros.actions import Node
from my_package.settings import TOPIC


def generate_launch_description():
    said = ExecuteProcess(cmd=["printenv", "PYTHONUNBUFFERED", "A"], output="log", cwd="/")
    return LaunchDescription([
        LogInfo(msg=TOPIC), Node(package="my_package", executable="x"), said,
        RegisterEventHandler(OnProcessExit(target_action=said, on_exit=[EmitEvent(event=Shutdown())])),
    ])
"""


def test_print_shows_the_description_of_a_launch_file_that_imports_its_package(bench: Bench) -> None:
    (bench.folder / "my_launch.py").write_text(LAUNCH_FILE_WITH_HANDLER)
    (bench.folder / "settings.py").write_text("TOPIC = 'chatter'")
    ran = bench.ros2("launch", "-p", "my_launch.py")
    assert [line.partition(" object at ")[0] for line in ran.stdout.splitlines()] == [
        "<launch.launch_description.LaunchDescription",
        "├── LogInfo('chatter')",
        "├── ExecuteProcess(cmd=[ExecInPkg(pkg='my_package', exec='x'), '--ros-args'], cwd=None, env=None, "
        "shell=False)",
        "├── ExecuteProcess(cmd=['printenv', 'PYTHONUNBUFFERED', 'A'], cwd=''/'', env=None, shell=False)",
        "└── RegisterEventHandler('<launch.event_handlers.on_process_exit.OnProcessExit",
        "    └── OnProcessExit(matcher='event == ProcessExited and ExecuteLocal(event.action)', handler='<actions>', "
        "handle_once=False)",
        "        └── EmitEvent(event='launch.events.Shutdown')",
    ]
    assert (ran.stderr, ran.code) == ("", 0)


@pytest.mark.parametrize(("value", "shown"), [("1", ["1", "b"]), ("ros-tutor", ["b"])])
def test_unbuffered_output_is_inherited_only_if_the_user_set_it(bench: Bench, value: str, shown: list[str]) -> None:
    text = LAUNCH_FILE_WITH_HANDLER.replace("from my_package.settings import TOPIC", "TOPIC = ''")
    (bench.folder / "my_launch.py").write_text(text.replace('Node(package="my_package", executable="x"), ', ""))
    words = ["launch", "-a", "--launch-prefix", "env A=b", "my_launch.py"]
    starting = replace(bench, server=None, env={**bench.env, "PYTHONUNBUFFERED": value})
    ran = starting.ros2(*words)
    assert [line.removeprefix("[env-1] ") for line in ran.stdout.splitlines() if line.startswith("[env-1]")] == shown


def test_a_launch_file_given_by_path_takes_arguments(bench: Bench) -> None:
    (bench.folder / "my_launch.py").write_text(LAUNCH_FILE)
    ran = bench.ros2("launch", "my_launch.py", "word:=one", "word:=two")
    assert ran.code == 0, ran.stderr
    assert "[echo-1] said two" in ran.stdout + ran.stderr
    assert not list((bench.folder / "log").rglob("ros2-overlay*"))


def test_a_launch_file_of_a_package_is_found(bench: Bench) -> None:
    package = bench.folder / "ws/src/talks"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>talks</name></package>")
    (package / "launch/say_launch.py").write_text(LAUNCH_FILE)
    ran = bench.ros2("launch", "talks", "say_launch.py")
    assert ran.code == 0, ran.stderr
    assert "[echo-1] said nothing" in ran.stdout + ran.stderr


@pytest.mark.parametrize("option", ["-s", "--show-args"])
def test_launch_arguments_are_listed(bench: Bench, option: str) -> None:
    (bench.folder / "my_launch.py").write_text(LAUNCH_FILE)
    ran = bench.ros2("launch", option, "my_launch.py")
    assert ran.code == 0
    assert "'word':" in ran.stdout
    assert "What to say" in ran.stdout
    assert "said" not in ran.stdout


@pytest.mark.parametrize(
    ("package", "first"),
    [("demo_nodes_py", 'Publishing: "Hello World: 0"'), ("demo_nodes_cpp", "Publishing: 'Hello World: 1'")],
)
def test_remapped_talker_and_listener_communicate(bench: Bench, package: str, first: str) -> None:
    names = ("--ros-args", "-r", "chatter:=news", "-r", "__ns:=/robot1")
    with (
        start(bench, "run", package, "listener", *names) as listener,
        start(bench, "run", package, "talker", *names) as talker,
    ):
        assert "[robot1.talker]" in read_until(talker, first)
        assert "[robot1.listener]" in read_until(listener, "I heard: [Hello World: ")
        for process in (talker, listener):
            os.killpg(process.pid, signal.SIGINT)
            rest, _ = process.communicate(timeout=LIMIT_S)
            assert process.returncode == 0, rest
    assert not list((bench.folder / "log").rglob("ros2-overlay*"))


def test_an_exit_code_is_passed_on(bench: Bench) -> None:
    package = bench.folder / "ws/src/ends"
    (package / "ends").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>ends</name></package>")
    (package / "setup.py").write_text("setup(entry_points={'console_scripts': ['five = ends.five:main']})")
    (package / "ends/__init__.py").touch()
    (package / "ends/five.py").write_text("import sys\ndef main():\n    print(sys.argv[1:])\n    return 5\n")
    ran = bench.ros2("run", "ends", "five", "--ros-args", "-s")
    assert (ran.code, ran.stdout) == (5, "['--ros-args', '-s']\n[ros2run]: Process exited with failure 5\n")


def test_ctrl_c_ends_the_whole_launch(bench: Bench) -> None:
    solution = Path(__file__).parents[2] / "lessons/i2_2/solution/my_launch.py"
    with start(bench, "launch", str(solution), "topic:=news") as process:
        read_until(process, "[minimal_subscriber]: I heard")
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(LIMIT_S) == 0
        with pytest.raises(ProcessLookupError):
            os.killpg(process.pid, 0)


def test_ros_tutor_ros2_runs_our_ros2(bench: Bench) -> None:
    program = [sys.executable, "-P", "-c", "import sys, tutor.cli; sys.exit(tutor.cli.main())", "ros2"]

    def tutor(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*program, *words],
            env=bench.env,
            cwd=bench.folder,
            capture_output=True,
            text=True,
            timeout=LIMIT_S,
            check=False,
        )

    (bench.folder / "my_launch.py").write_text(LAUNCH_FILE)
    assert "said here" in (ran := tutor("launch", "my_launch.py", "word:=here")).stdout + ran.stderr
    assert "'word':" in tutor("launch", "my_launch.py", "--show-args").stdout
    assert tutor("topik").returncode == 2
    assert tutor().stdout.startswith("usage: ros2")


@pytest.mark.parametrize(("before", "code"), [("rclpy.try_shutdown()", 0), ("pass", 1)])
def test_an_error_of_rclpy_that_follows_from_ctrl_c_is_no_failure(bench: Bench, before: str, code: int) -> None:
    nodes = Path(bundled_ros.__file__).parent / "demo/nodes.py"
    program = (
        "import runpy, sys, rclpy\n"
        f"def spin(node):\n    {before}\n    raise RuntimeError('the given context is not valid')\n"
        "rclpy.spin = spin\nsys.argv = ['', 'demo_nodes_py', 'talker']\n"
        f"runpy.run_path({str(nodes)!r}, run_name='__main__')\n"
    )
    ran = bench.python("-c", program)
    assert ran.code == code, ran.stderr


def test_a_demo_node_fails_if_its_arguments_cannot_be_parsed(bench: Bench) -> None:
    ran = bench.ros2("run", "demo_nodes_py", "listener", "--ros-args", "-r", "__node:=no-name")
    assert ran.code != 0
    assert "Failed to parse global arguments" in ran.stderr


def test_a_demo_node_ends_cleanly_if_ctrl_c_has_just_shut_its_context_down(bench: Bench) -> None:
    nodes = Path(bundled_ros.__file__).parent / "demo/nodes.py"
    program = (
        "import runpy, sys, rclpy\n"
        "def spin(node):\n    raise KeyboardInterrupt\n"
        "def try_shutdown():\n    raise RuntimeError('rcl_shutdown already called on the given context')\n"
        "rclpy.spin, rclpy.utilities.try_shutdown = spin, try_shutdown\n"
        "sys.argv = ['', 'demo_nodes_py', 'talker']\n"
        f"runpy.run_path({str(nodes)!r}, run_name='__main__')\n"
    )
    ran = bench.python("-c", program)
    assert (ran.code, ran.stderr) == (0, "")
