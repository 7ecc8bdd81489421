"""`ros-tutor shell`: a sourced terminal."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.ros2cli.bench import TALKER, Bench, Ran
from tests.ros2cli.pseudo_terminal import terminal
from tests.ros2cli.users import TUTOR, on_an_ordinary_domain, user_env
from tutor.bundled_ros.ros2.absent import ABSENT

NODE = """
import rclpy
def main():
    rclpy.init()
    print("made", rclpy.create_node("mine").get_name())
if __name__ == "__main__":
    main()
"""


def run_tutor(bench: Bench, *words: str, env: dict[str, str]) -> Ran:
    ran = subprocess.run(
        [*TUTOR, *words], env=env, cwd=bench.folder, capture_output=True, text=True, timeout=60, check=False
    )
    return Ran(ran.stdout, ran.stderr, ran.returncode)


@pytest.fixture(scope="module")
def bench(module_bench: Bench) -> Iterator[Bench]:
    with on_an_ordinary_domain(module_bench) as bench:
        yield bench


@pytest.fixture(scope="module")
def workspace(bench: Bench) -> Path:
    """A workspace with a node of the learner's. The tests leave it as it is."""
    root = bench.folder / "ws"
    assert run_tutor(bench, "start", "i1.1", "--workspace", str(root), env=user_env(bench)).code == 0
    (root / "src/my_package/my_package/mine.py").write_text(NODE)
    return root


@pytest.fixture(scope="module")
def talker_bench(bench: Bench) -> Iterator[Bench]:
    """The bench with a talker on its domain."""
    with bench.node(TALKER):
        yield bench


def test_a_command_line_is_run_as_in_a_sourced_terminal(talker_bench: Bench, workspace: Path) -> None:
    env = user_env(talker_bench)
    files = sorted(path for path in talker_bench.folder.rglob("*") if "log" not in path.parts)

    def shell(line: str) -> Ran:
        return run_tutor(talker_bench, "shell", "--workspace", str(workspace), "-c", line, env=env)

    commands_and_outputs = {
        "ros2 topic type /chatter": "std_msgs/msg/String\n",
        "ros2 topic echo --once /chatter | head -c 20; echo": "data: 'Hello World: \n",
        "ros2 run my_package mine": "made mine\n",
        f"(cd {workspace}/src/my_package/my_package && python3 mine.py)": "made mine\n",
        "python3 -c 'import my_package.mine as mine; mine.main()'": "made mine\n",
        "echo $ROS_DOMAIN_ID": f"{env['ROS_DOMAIN_ID']}\n",
        "ros-tutor list --help >/dev/null && echo helped": "helped\n",
    }
    script = "set -e\n" + "\n".join(commands_and_outputs) + "\nset +e; ros2 topic type /nothing; exit 7"
    assert shell(script) == Ran("".join(commands_and_outputs.values()), "", 7)
    assert shell("kill -TERM $$").code == 128 + signal.SIGTERM
    new = sorted(path for path in talker_bench.folder.rglob("*") if "log" not in path.parts)
    assert [path for path in new if path not in files] == []


def test_the_workspaces_domain_is_used_if_none_is_set(bench: Bench, workspace: Path) -> None:
    env = user_env(bench)
    del env["ROS_DOMAIN_ID"]
    domains = {run_tutor(bench, "shell", "--workspace", str(workspace), "-c", "echo $ROS_DOMAIN_ID", env=env).stdout}
    assert domains == {(workspace / ".ros-tutor/domain").read_text()}


def test_an_installed_ros2_takes_precedence(bench: Bench, workspace: Path, tmp_path: Path) -> None:
    own = tmp_path / "own"
    own.mkdir()
    (own / "ros2").write_text("#!/bin/sh\necho the real one\n")
    (own / "ros2").chmod(0o755)
    env = user_env(bench, PATH=f"{own}:{os.environ['PATH']}")
    assert run_tutor(bench, "shell", "--workspace", str(workspace), "-c", "ros2", env=env).stdout == "the real one\n"


RC = """
FROM_RC=read
PS1='users> '
export AMENT_PREFIX_PATH=/opt/ros/other PATH=/somewhere/else:$PATH ROS_DISTRO=other
"""


def test_the_users_own_shell_is_run(talker_bench: Bench, workspace: Path, tmp_path: Path) -> None:
    (tmp_path / ".bashrc").write_text(RC)
    command = [*TUTOR, "shell", "--workspace", str(workspace)]
    env = user_env(talker_bench, HOME=str(tmp_path), TMPDIR=str(tmp_path))
    with terminal(command, env, talker_bench.folder) as shell:
        shell.until("workspace ")
        shell.until("(ROS 2: ws) users> ")
        shell.type('echo "$FROM_RC, ${ROS_DISTRO-unset}, $?"\n')
        shell.until("\r\nread, unset, 0\r\n")
        shell.type("ros2 topic ty\t")
        shell.until("ros2 topic type ")
        shell.type("/chat\t")
        shell.until("/chatter ")
        shell.type("\n")
        shell.until("std_msgs/msg/String")
        shell.type("ros2 run my_p\t")
        shell.until("my_package ")
        shell.type("min\t\t")
        shell.until("mine")
        shell.type("e\n")
        shell.until("made mine")
        shell.type("ros2 topic hz /nothing\n")
        shell.until("does not appear to be published yet")
        shell.type("\x03")
        shell.until("(ROS 2: ws) users> ")
        shell.type("echo code $?\n")
        shell.until("\r\ncode 2\r\n")
        shell.type("exit 3\n")
        assert shell.end() == 3
    assert not list(tmp_path.rglob("shell.*"))
    assert (tmp_path / ".bashrc").read_text() == RC


@pytest.mark.skipif(shutil.which("zsh") is None, reason="zsh is not installed")
def test_zsh_is_run_if_it_is_the_users_shell(talker_bench: Bench, workspace: Path, tmp_path: Path) -> None:
    (tmp_path / ".zshrc").write_text("FROM_RC=read\nPROMPT='users> '\n")
    command = [*TUTOR, "shell", "--workspace", str(workspace)]
    env = user_env(talker_bench, SHELL=shutil.which("zsh") or "", HOME=str(tmp_path))
    with terminal(command, env, talker_bench.folder) as shell:
        shell.until("(ROS 2: ws) users> ")
        shell.type('echo "$FROM_RC, ${ZDOTDIR-unset}"\n')
        shell.until("read, unset")
        shell.type("ros2 topic ty\t")
        shell.until("ros2 topic type")
        shell.type(" /chat\t")
        shell.until("/chatter")
        shell.type("\n")
        shell.until("std_msgs/msg/String")
        shell.type("exit 3\n")
        assert shell.end() == 3


def test_variables_of_an_installed_ros_are_kept(tmp_path: Path) -> None:
    from tutor.bundled_ros.ros2.sourced import setup_file, sourced_environment
    from tutor.ros.environment import RosEnvironment

    installed = RosEnvironment("system", "jazzy", Path("/usr/bin/python3.12"), "rmw_fastrtps_cpp")
    environ = {
        "PATH": "/opt/ros/jazzy/bin:/usr/bin",
        "AMENT_PREFIX_PATH": "/opt/ros/jazzy",
        "PYTHONPATH": "/opt/ros/py",
    }
    env = sourced_environment(installed, tmp_path, 7, tmp_path / "tools", environ)
    assert env == {**environ, "ROS_DOMAIN_ID": "7", "ROS_TUTOR_WORKSPACE": str(tmp_path)}
    assert not (tmp_path / "tools").exists()
    assert setup_file(installed, tmp_path, "bash") is None
    (tmp_path / "install").mkdir()
    (tmp_path / "install/local_setup.bash").touch()
    assert setup_file(installed, tmp_path, "bash") == tmp_path / "install/local_setup.bash"


@pytest.mark.parametrize("wrapper", [[], ["nohup"]])
def test_killing_the_shell_kills_its_command(bench: Bench, workspace: Path, wrapper: list[str]) -> None:
    command = [*wrapper, *TUTOR, "shell", "-c", "echo up; exec sleep 600", "--workspace", str(workspace)]
    shell = subprocess.Popen(command, env=user_env(bench), stdout=subprocess.PIPE)
    assert shell.stdout is not None
    with shell.stdout:
        assert shell.stdout.readline() == b"up\n"
        shell.kill()
        shell.wait()
        assert shell.stdout.read() == b""  # EOF: the command, which had the pipe open, is gone


def test_a_program_that_is_not_here_says_what_to_do_instead(bench: Bench, workspace: Path, tmp_path: Path) -> None:
    def shell(line: str, **more: str) -> Ran:
        return run_tutor(bench, "shell", "--workspace", str(workspace), "-c", line, env=user_env(bench, **more))

    for name in ABSENT:
        ran = shell(f"{name} --help", PATH="/usr/bin:/bin")
        assert (ran.stdout, ran.code, ran.stderr.count("\n")) == ("", 127, 1), name
        assert ran.stderr.startswith(f"{name} ")
    installed = tmp_path / "colcon"
    installed.write_text("#!/bin/sh\necho the real one\n")
    installed.chmod(0o755)
    assert shell("colcon", PATH=f"{tmp_path}:/usr/bin:/bin").stdout == "the real one\n"
    assert shell(f"PATH=/usr/bin:$PATH; cp {installed} $TMPDIR; PATH=$TMPDIR:$PATH colcon").stdout == "the real one\n"


def test_a_new_package_runs_where_the_tutorials_next_commands_fail(bench: Bench, workspace: Path) -> None:
    script = f"""
        cd {workspace}/src && ros2 pkg create --build-type ament_python --node-name hello greeter > /dev/null
        cd .. && PATH=/usr/bin:/bin:$PATH colcon build --packages-select greeter
        ros2 run greeter hello; cd / && ros2 run greeter hello; rm -r {workspace}/src/greeter
    """
    ran = run_tutor(bench, "shell", "--workspace", str(workspace), "-c", script, env=user_env(bench))
    assert (ran.stdout, ran.code) == ("Hi from greeter.\n" * 2, 0)
    assert ran.stderr.startswith("colcon is not installed, and not needed here: ")
